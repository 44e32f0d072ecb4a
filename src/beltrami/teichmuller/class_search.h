#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/hyperbolic_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct ClassSearchOptions {
    int starts = 8;          ///< at least 1
    int vertices = 2500;     ///< about, of the coarse mesh of the source on which classes are compared
    std::uint64_t seed = 1;  ///< of the roots at which the surfaces are cut open
    /// Called after every start with their number; returning false cancels.
    std::function<bool(int done, int all)> progress;
};

/// The classes that were reached, and the one whose harmonic map has the least energy.
struct ClassSearch {
    /// One start and where it led.
    struct Reached {
        double energy = 0;          ///< of the harmonic map, on the coarse mesh
        double homology_bound = 1;  ///< of K in its class (HyperbolicMap::K_homology), there
        Eigen::MatrixXi homology;   ///< as HyperbolicMap::homology
        int twists = 0;             ///< Dehn twists from the start
    };
    std::vector<Reached> reached;  ///< by energy
    int failed = 0;                ///< starts that came to nothing, as rounding spoiled their words
    EquivariantMap map;            ///< of the source, in the class of reached[0]
};

/// Seeks a class of maps between closed surfaces of genus 2 or more of which nothing is known. A start cuts both
/// surfaces open somewhere (marking_by_cutting). Dehn twists of the source about short curves act on its homology class
/// by integer matrices: a beam search over their products looks for the least homology bound, and the word that was
/// found is then applied to the map, twist by twist. What remains, a class that acts on homology alike (an element of
/// the Torelli group), only the energy of the harmonic map tells: of several starts the least is taken. No optimum over
/// all classes is proved, and equal surfaces may have several that are alike.
/// @throw Error bad_mesh unless the surfaces are closed, of one genus, the source in triangles; not_solved where no
/// start
///        led anywhere; cancelled
ClassSearch search_class(const HyperbolicShape& source, const HyperbolicShape& target,
                         const ClassSearchOptions& options = {});

}  // namespace beltrami
