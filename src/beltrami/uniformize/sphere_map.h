#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Ways to map a closed surface to the sphere.
enum class SphereMethod {
    conformal_equivalence,  ///< discrete uniformization: conformal for the surface as a metric, second order
    least_distortion,       ///< the map without folds of least mean distortion on this mesh, from Tutte's
    tutte,                  ///< every vertex a mean of its neighbours: no folds, far from conformal
};
const char* to_string(SphereMethod);

/// What had to be done until no face was flipped.
enum class SphereRoute {
    direct,    ///< nothing
    averaged,  ///< a few vertices were put at means of their neighbours
    unfolded,  ///< vertices were moved to open folds that this had left
    fallback,  ///< least_distortion, as conformal equivalence did not do
};
const char* to_string(SphereRoute);

struct SphereMapOptions {
    SphereMethod method = SphereMethod::conformal_equivalence;
    double tolerance = 1e-10;  ///< largest angle defect that is left, radians
    int max_iterations = 200;  ///< Newton steps for one ideal vertex
    /// The vertex that is sent to infinity on the way; the map does not depend on it but for rounding. Nothing: one
    /// with an even star is chosen, others being tried where that fails.
    std::optional<int> ideal_vertex;
    bool fall_back = true;  ///< whether least_distortion may take the place of a method that fails

    /// @throw Error bad_option
    void validate() const;
};

/// A map of a closed surface of genus 0 to the unit sphere, and what is to be known about it. No face is flipped: the
/// geodesic triangles cover the sphere once.
struct SphereMap {
    Positions positions;        ///< #V×3 unit vectors; (0, 0, 1) at vertices without faces
    Eigen::VectorXd log_scale;  ///< #V: of conformal equivalence, log of the scale factor that makes chords from
                                ///< lengths, up to a Möbius map; else empty
    Distortion distortion;      ///< from the surface to the straight (chordal) faces between the points
    SphereMethod method = SphereMethod::conformal_equivalence;  ///< that found it
    SphereRoute route = SphereRoute::direct;
    std::optional<int> ideal_vertex;
    int moved = 0;  ///< vertices that were moved to turn flipped faces up
    int iterations = 0;
    int factorizations = 0;
    int flips = 0;               ///< of intrinsic edges
    double lengthened = 0;       ///< as of Flattening
    double residual = 0;         ///< largest angle defect left, radians
    double layout_error = 0;     ///< as of Flattening
    double centre_distance = 0;  ///< of the centre of mass, by source area, from the sphere's centre
    /// Faces with an edge below 1e-13 of the sphere's radius: what doubles cannot place, of limbs that the map makes
    /// tiny; ascending. And their share of the source's area.
    std::vector<int> unresolved;
    double unresolved_area = 0;
    Warnings warnings;
};

/// @throw Error bad_mesh unless the surface is one component, closed and of genus 0
void require_sphere(const Surface& surface);

/// The conformal map of a closed surface of genus 0 to the round sphere, in the sense of discrete conformal
/// equivalence: scale factors at the vertices make it a convex polyhedron inscribed in the sphere, found by Newton's
/// method on a convex energy with one vertex at infinity, while intrinsic edge flips keep the scaled metric Delaunay.
/// The Möbius map is chosen that puts the centre of mass at the sphere's centre; rotations remain.
///
/// - The result depends on the surface and not on how it is triangulated, nor on the ideal vertex, to rounding.
/// - Where edges of the mesh had to be flipped a face drawn between the points may come out flipped: then a few
///   vertices around it are moved (sphere_repair.h); where that does not do, or the iteration fails, the map of least
///   distortion on this mesh is taken; where that fails too this is an error, which says which share of the surface the
///   map makes so small that double precision does not resolve it. A map with flipped faces is never returned.
/// - Faces run counter-clockwise as seen from outside the sphere.
///
/// Source: Springborn 2020, "Ideal hyperbolic polyhedra and discrete uniformization"; Gillespie, Springborn, Crane
/// 2021, "Discrete conformal equivalence of polyhedral surfaces"; Baden, Crane, Kazhdan 2018, "Möbius registration".
/// @throw Error bad_option; bad_mesh unless the surface is one component, closed and of genus 0; not_solved if no way
///        leads to a map without flipped faces, naming those of the best one
SphereMap sphere_map(const Surface& source, const SphereMapOptions& options = {});

/// The same of a mesh of polygons with any number of corners. Those that are cut into triangles before
/// (split_unusable_faces) stand as such in the distortion; faces are named as the mesh has them.
/// @throw Error as above, and for fatal findings of the diagnosis
SphereMap sphere_map(const Mesh& polygons, const SphereMapOptions& options = {});

}  // namespace beltrami
