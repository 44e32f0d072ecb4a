#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <beltrami/beltrami.h>

/// Deformations and spoiled meshes that several programs measure.
namespace beltrami::bench {

struct Handles {
    std::vector<int> vertices;
    Positions places;  ///< #vertices×3
};

/// The lower rim of a cylinder about the z-axis stays, the upper one is lowered by a function of the angle.
Handles rims(const Mesh& mesh, const std::function<double(double angle)>& lowered);

/// The boundary of the unit square in the plane, one corner of which is pushed in.
Handles arrow_head(const Mesh& square, double push);

/// Boundary loops turned about their axes, pulled along them and scaled; every other one the other way, if wanted.
Handles turned(const Mesh& mesh, double angle, double pull, double scale, bool alternating);

/// Quads of a grid, so many rows to a column, as two triangles each, diagonals this way and that.
Mesh alternating_triangles(const Mesh& quads, int rows);
/// The cylinder of radius 1 and height 2, 48 × 16 cells or so many times more each way.
Mesh cylinder_to_lower(int fineness, Cells cells);
/// The torus of radii 2 and 1 with a hole at its outer equator, 4 008 faces, diagonals of its grid this way and that.
Mesh torus_with_hole();
/// The sphere with a hole at each of six ends, 6 128 faces.
Mesh sphere_with_holes();

/// Mesh less the faces within two rings of so many vertices, each the farthest from those before.
Mesh with_holes(const Mesh& mesh, int holes, int rings = 2);

/// Which vertices are on borders and features.
std::vector<char> on_curves(const Mesh& mesh, const Topology& combinatorics, std::optional<double> angle);

/// Vertices inside, and not on features, moved at random by at most so much of their shortest edge, along the surface.
Mesh with_noise(const Mesh& mesh, double amount, std::optional<double> features);

}  // namespace beltrami::bench
