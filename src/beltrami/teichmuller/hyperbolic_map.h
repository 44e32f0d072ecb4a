#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/forms/harmonic_basis.h>
#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/hyperbolic/marking.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/distance.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What is worked out once of a surface with a metric of curvature −1, whatever it is mapped to: a closed one of genus
/// 2 or more, or one with boundary loops and a negative Euler characteristic.
class HyperbolicShape {
  public:
    /// @param surface kept by reference
    /// @throw Error as hyperbolic_surface and harmonic_basis; bad_mesh for faces that are not triangles where edges are
    ///        to be split
    explicit HyperbolicShape(const Surface& surface);
    HyperbolicShape(const HyperbolicShape&) = delete;
    HyperbolicShape& operator=(const HyperbolicShape&) = delete;

    /// The surface, with edges across it that join two boundary vertices split (split_bridges): along the boundary, a
    /// geodesic, such triangles would have no area. Maps are of this one; its first vertices are the given ones.
    const Surface& surface() const { return split_surface_ ? *split_surface_ : given_; }
    /// As it was given.
    const Surface& given() const { return given_; }
    /// How it was split; nothing if there was no need.
    const std::optional<SplitProblem>& split() const { return split_; }
    const HyperbolicSurface& metric() const { return metric_; }
    const HarmonicBasis& forms() const { return forms_; }
    /// What a class of maps onto it is told by.
    EdgeGroup group() const { return {metric_.original, metric_.steps, surface().topology, forms_.homology}; }

    /// The holomorphic quadratic differentials: products of 1-forms where these span them (holomorphic_products.h),
    /// else the kernel of ∂̄, which tells in any case that none is missing (hyperbolic_space.h). Of surfaces with a
    /// boundary that kernel, real along it. Worked out when first asked for, by one thread.
    struct Differentials {
        std::shared_ptr<const DifferentialSpace> space;
        Eigen::VectorXd kernel;  ///< 3g − 3 eigenvalues that are 0 but for the mesh
        double next = 0;         ///< and the next one, ½ but for the mesh
        int solves = 0;
    };
    /// @throw Error as hyperbolic_space
    const Differentials& differentials() const;

  private:
    const Surface& given_;
    std::optional<SplitProblem> split_;
    std::optional<Surface> split_surface_;
    HyperbolicSurface metric_;
    HarmonicBasis forms_;
    mutable std::optional<Differentials> differentials_;
};

struct HyperbolicMapOptions : IterationOptions {
    // tolerance: stop when φ changes by less than this and k by less than a hundredth of it. 0: 1e-6.
    HyperbolicMapOptions() { max_iterations = 60; }
};

/// The extremal map between two surfaces in a class, along whose boundary, if there is one, it slides; and how good it
/// is: of HyperbolicShape::surface() of the source, its places on the faces of the target as given. `distortion` of the
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
    Eigen::MatrixXi homology;  ///< periods of the target's forms (columns) around images of the source's loops
    double k_in_space = 0;     ///< the c-step of that map
    double energy = 0;         ///< of the harmonic map of the class, before the iteration
    int start_steps = 0;       ///< Newton steps to it
    std::vector<Iteration> history;
};

/// Hamilton's iteration over the differentials of the source, its maps harmonic onto the hyperbolic metric of the
/// target. There are 3g − 3 of a closed surface. One with a boundary is half of its double, whose genus is g: there are
/// as many that are real along the boundary, and with real coefficients.
/// @param start in the class wanted, anywhere (Marking::map)
/// @throw Error bad_mesh unless both have the same genus and as many boundary loops, and the source is of triangles;
///        bad_option if the start turns the orientation round or boundary loops do not go once around others;
///        not_solved, cancelled
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
