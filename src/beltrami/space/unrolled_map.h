#pragma once

#include <optional>
#include <vector>

#include <beltrami/space/uniform_map.h>
#include <beltrami/targets/parametric_target.h>

namespace beltrami {

/// The places of vertices on a surface that is the plane rolled up, unrolled face by face.
struct UnrolledPlaces {
    Eigen::VectorXcd vertices;  ///< #V
    Eigen::VectorXcd turns;     ///< #corners: what is added to a vertex's place so that the face hangs together
};

/// Nothing where the target cannot be unrolled.
std::optional<UnrolledPlaces> unrolled_places(const ParametricTarget& target, const FaceList& faces,
                                              const Target::Points& points);
/// Points of the target again.
Target::Points rolled_up(const ParametricTarget& target, const Eigen::VectorXcd& vertices);

/// The least-squares map with a coefficient onto such a surface: one linear solve, after which vertices are on it.
/// @param mu #S, |μ| < 1, in the elements' frames
/// @return #V unrolled; what is fixed stays, and which turn the faces are in
/// @throw Error not_solved
Eigen::VectorXcd unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                              const std::vector<char>& fixed, const Eigen::VectorXcd& mu);

struct UnrolledMap {
    Eigen::VectorXcd vertices;  ///< #V unrolled
    Eigen::VectorXcd first;     ///< the least-squares conformal map with which it begins
    int solves = 0;
    bool converged = false;
};

/// The QC iteration of uniform_map where the image is such a surface: every solve is one of a harmonic map's size, for
/// both coordinates, and the map stays on the surface.
/// @param places of the vertices; which turn the faces are in is kept, and so are fixed vertices
/// @param fixed  #V, at least one
/// @throw Error bad_option, not_solved, cancelled
UnrolledMap uniform_unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                                 const std::vector<char>& fixed, const UniformOptions& options = {});

}  // namespace beltrami
