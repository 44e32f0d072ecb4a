#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/forms/harmonic_basis.h>
#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/hyperbolic/marking.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/distance.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What is worked out once of a closed surface of genus 2 or more, whatever it is mapped to.
class HyperbolicShape {
  public:
    /// @param surface kept by reference
    /// @throw Error as hyperbolic_surface and harmonic_basis
    explicit HyperbolicShape(const Surface& surface);

    const Surface& surface() const { return surface_; }
    const HyperbolicSurface& metric() const { return metric_; }
    const HarmonicBasis& forms() const { return forms_; }
    /// What a class of maps onto it is told by.
    EdgeGroup group() const { return {metric_.original, metric_.steps, surface_.topology, forms_.homology}; }

    /// The holomorphic quadratic differentials: products of 1-forms where these span them (holomorphic_products.h),
    /// else the kernel of ∂̄, which tells in any case that none is missing (hyperbolic_space.h). Worked out when first
    /// asked for, by one thread.
    struct Differentials {
        std::shared_ptr<const DifferentialSpace> space;
        Eigen::VectorXd kernel;  ///< 3g − 3 eigenvalues that are 0 but for the mesh
        double next = 0;         ///< and the next one, ½ but for the mesh
        int solves = 0;
    };
    /// @throw Error as hyperbolic_space
    const Differentials& differentials() const;

  private:
    const Surface& surface_;
    HyperbolicSurface metric_;
    HarmonicBasis forms_;
    mutable std::optional<Differentials> differentials_;
};

struct HyperbolicMapOptions : IterationOptions {
    // tolerance: stop when φ changes by less than this and k by less than a hundredth of it. 0: 1e-6.
    HyperbolicMapOptions() { max_iterations = 60; }
};

/// The extremal map between two closed surfaces of genus 2 or more in a class, and how good it is. `distortion` of the
/// base is that of the source's faces onto geodesic triangles of the target's hyperbolic metric; `map` is empty.
struct HyperbolicMap : MapResult, CarriedSurface {
    double k = 0, K = 1;  ///< of the last c-step: estimates of k* and K*
    /// 1/I⁻ and I⁺ of the Reich-Strebel inequality: estimates of bounds, as φ is holomorphic up to the mesh. 1 and
    /// infinite where faces are flipped.
    double K_lower = 1, K_upper = std::numeric_limits<double>::infinity();
    /// No map in the class has less: by this factor it changes the energy of some harmonic form. Of the two polyhedra
    /// up to the mesh; where K is below, the mesh does not resolve it.
    double K_homology = 1;
    QuadraticDifferential differential;                ///< zero() where the map is conformal
    Eigen::VectorXcd phi;                              ///< #S its values at the samples
    double weighted_mean = 0, weighted_deviation = 0;  ///< of |μ| by |φ|: k and 0 of the extremal map
    EquivariantMap equivariant;
    Eigen::MatrixXi homology;  ///< 2g×2g: periods of the target's forms (columns) around images of the source's loops
    double k_in_space = 0;     ///< the c-step of that map
    double energy = 0;         ///< of the harmonic map of the class, before the iteration
    int start_steps = 0;       ///< Newton steps to it
    std::vector<Iteration> history;
};

/// Hamilton's iteration over the 3g − 3 differentials of the source, its maps harmonic onto the hyperbolic metric of
/// the target.
/// @param start in the class wanted, anywhere (Marking::map)
/// @throw Error bad_mesh unless both have the same genus and the source is of triangles; bad_option if the start turns
///        the orientation round; not_solved, cancelled
HyperbolicMap hyperbolic_map(const HyperbolicShape& source, const HyperbolicShape& target, EquivariantMap start,
                             const HyperbolicMapOptions& options = {});

/// The least dilatation that a class can have for what it does to the energies of harmonic forms: the largest
/// eigenvalue of one pulled back against the other, and its inverse.
/// @throw Error bad_option unless the class keeps the intersection numbers
double homology_bound(const HyperbolicShape& source, const HyperbolicShape& target, const Eigen::MatrixXi& homology);

/// The class of the inverse of a map that was placed on the target: every vertex of the target goes near the vertex of
/// the source whose image is nearest.
/// @throw Error as marking_by_vertices
Marking inverse_marking(const HyperbolicShape& source, const HyperbolicShape& target, const HyperbolicMap& map);

/// The distance of two maps, each of one surface onto the other.
Distance hyperbolic_distance_of(const HyperbolicMap& there, const HyperbolicMap& back);

}  // namespace beltrami
