#pragma once

#include <array>
#include <optional>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Bounds of a modulus from both sides, each a proof up to rounding: energies of functions that are admissible in
/// Dirichlet's principle, on the surface itself.
struct ModulusBracket {
    double lower, upper;
    int factorizations = 0;
};

/// A disk with four sides: sides[i] are its boundary vertices from corner i to corner i + 1, ends included.
using Sides = std::array<std::vector<int>, 4>;

/// The sides of a boundary loop between four of its positions, ascending.
Sides sides_between(const std::vector<int>& loop, const std::array<int, 4>& positions);

/// The two harmonic functions of a disk with four sides: u is 0 on side 3 and 1 on side 1, v is 0 on side 0 and 1 on
/// side 2, and nothing else is held. Two factorisations.
struct QuadrilateralPotentials {
    Eigen::VectorXd u, v;  ///< #V
    double u_energy = 0, v_energy = 0;
    int factorizations = 0;
};
/// @throw Error not_solved
QuadrilateralPotentials quadrilateral_potentials(const Operators& operators, const Sides& sides);

/// The extremal distance between sides 3 and 1 (width over height for a rectangle with side 0 below): 1/D of the
/// function that is 0 on one and 1 on the other from below, D of that of sides 0 and 2 from above. Two factorisations.
/// @throw Error not_solved
ModulusBracket quadrilateral_modulus(const Operators& operators, const Sides& sides);

/// The extremal distance between the two boundary loops of a ring, log(R/r)/2π for radii R and r: 1/D of the
/// function that is 0 on one and 1 on the other from below, D of the function that grows by 1 around from above.
/// @pre two boundary loops, genus 0
/// @throw Error not_solved
ModulusBracket ring_modulus(const Surface& ring);
/// The same in another metric of the same faces.
/// @param operators of triangles with the faces of @p ring, or of its own
ModulusBracket ring_modulus(const Surface& ring, const Operators& operators);

/// Between the circles of a round ring, not need to be concentric.
double round_ring_modulus(Complex outer_centre, double outer_radius, Complex hole_centre, double hole_radius);

/// 𝒦(√(1−x))/𝒦(√x) (complete elliptic integrals of the first kind) by arithmetic-geometric means, 0 < x < 1.
/// @param complement 1 − x, given apart because either may be tiny
double elliptic_ratio(double x, double complement);

/// The extremal distance between the arcs from angle t[3] to t[0] and from t[1] to t[2] of the unit disk, t ascending
/// within 2π.
double disk_modulus(const std::array<double, 4>& t);

/// The least K of a map from one modulus to another, as far as brackets of both prove it.
double modulus_ratio(const ModulusBracket& source, const ModulusBracket& image);

/// The four positions on the outer loop whose images are the corners of a rectangle that the loop goes to, and its
/// width over height, where the boundary of a disk goes to one: every image lies on a side to rounding.
struct RectangleImage {
    std::array<int, 4> positions;
    double modulus;
};
std::optional<RectangleImage> rectangle_image(const std::vector<Complex>& images);

}  // namespace beltrami
