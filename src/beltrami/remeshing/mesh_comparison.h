#pragma once

#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/targets/mesh_target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Angles of the faces of a mesh, degrees. Deviations are those from the angle of a regular polygon: 60 of triangles,
/// 90 of quads.
struct AngleStatistics {
    double smallest = 0, one_percent = 0, largest = 0;  ///< one percent of the angles are below one_percent
    double median_deviation = 0, mean_deviation = 0;
    std::array<int, 18> histogram{};  ///< corners with angles in [10 i, 10 (i+1))
};

AngleStatistics angle_statistics(const Mesh& mesh);

/// How far apart two surfaces are, both ways, sampled at vertices, at the middles of edges and of triangles. In the
/// units of the positions.
struct SurfaceDistance {
    double largest = 0, mean = 0;
};

SurfaceDistance surface_distance(const MeshTarget& a, const MeshTarget& b);

/// Faces whose normal opposes that of a surface near which they lie, at the point nearest to their middle.
/// @param points #V where the vertices lie on it, or none: the same is found sooner
std::vector<int> opposed_faces(const Mesh& mesh, const MeshTarget& surface, const Target::Points& points = {});

/// Σ of the faces' areas (of their vector areas).
double surface_area(const Mesh& mesh);

/// |μ| that an isosceles triangle needs against an equilateral one if m of them fill a full angle: what a vertex with m
/// triangles costs at least if these are alike.
double valence_floor(int m);

}  // namespace beltrami
