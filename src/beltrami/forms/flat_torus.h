#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/forms/homology.h>
#include <beltrami/forms/torus_marking.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/operators/distortion.h>

namespace beltrami BELTRAMI_PUBLIC {

namespace detail {
struct DelaunayForms;
}

/// A closed surface of genus 1 on the plane modulo the lattice ℤ + τℤ.
struct FlatTorus {
    HomologyBasis homology;   ///< of the surface: two loops
    TorusMarking generators;  ///< a and b in terms of these loops (columns); a·b = 1
    Complex tau;              ///< the period of b, where that of a is 1; in the fundamental domain
    /// The polyhedron's own τ is no farther away in hyperbolic distance: ½ log det E ≥ 0 of the forms' energies E,
    /// which bound those of the harmonic forms from above, and through the star from below.
    double tau_error = 0;
    /// #V×2: coordinates (α, β) of a vertex' place α + τβ, one of those that differ by integers.
    Positions lattice;
    /// Where the faces lie in one piece of the plane, cut along edges: those whose middle lies in the parallelogram
    /// 0 ≤ α, β < 1 over the first corner of the first face. A vertex has several points on the cut.
    TextureCoordinates layout;
    Distortion distortion;  ///< of the map to the layout, face by face, whose flipped faces are listed there
    int flips = 0;          ///< of edges to the intrinsic Delaunay triangulation
    int factorizations = 0;
    std::shared_ptr<const detail::DelaunayForms> forms;  ///< on the triangulation that none of whose faces is flipped
};

/// The flat metric of a torus: harmonic maps to it, by one factorisation. On the intrinsic Delaunay triangulation,
/// whose cotangent weights are never negative, no triangle is flipped (Gortler, Gotsman, Thurston 2006, "Discrete
/// one-forms on meshes and applications to 3D mesh parameterization"); faces of the surface itself that have lost an
/// edge to it may be drawn flipped.
/// @throw Error bad_mesh unless the surface is one component, closed, of genus 1; not_solved if triangles are flipped
///        all the same, by rounding
FlatTorus flat_torus(const Surface& surface);

/// Areas of the samples' faces in the flat metric, |φ| of its quadratic differential dz² (triangles), by which the map
/// of least L² norm of |μ| is extremal. #F, positive; where an edge was flipped a face may count by its mirror image.
std::vector<double> flat_areas(const FlatTorus& torus, const FaceList& faces);

/// Places on the surface of points of the plane modulo the lattice, exactly on its faces in its own metric.
/// @param lattice_points n×2 coordinates (α, β)
std::vector<MeshPoint> places_on_torus(const FlatTorus& torus, const Positions& lattice_points);

/// The class of a closed path of vertices in terms of the generators a and b.
/// @throw Error as homology_class
Eigen::Vector2i torus_class(const Surface& surface, const FlatTorus& torus, std::span<const int> path);

/// The marking that sends two closed paths on one torus to two on another.
/// @throw Error bad_option unless the classes determine it, in integers and keeping the orientation; as homology_class
TorusMarking marking_of_paths(const Surface& from, const FlatTorus& flat_from,
                              const std::array<std::vector<int>, 2>& paths_from, const Surface& to,
                              const FlatTorus& flat_to, const std::array<std::vector<int>, 2>& paths_to);

}  // namespace beltrami
