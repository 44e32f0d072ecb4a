#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/differentials/quadratic_differential.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A zero or pole of a quadratic differential: where |order + 2| of its horizontal trajectories meet.
struct CriticalPoint {
    MeshPoint place;
    int order;         ///< −1: a simple pole; n ≥ 1: a zero of order n
    bool on_boundary;  ///< not farther from it than a quarter of the edge there, and moved onto it
};

/// Zeros of φ, and its poles as far as they are simple and at phi.poles.
///
/// Of φ in a chart, by the argument principle in the chart's plane (argument_principle.h): places are exact up to the
/// chart, which is linear on faces (exact of φ(z) of one's own on a planar source). Next to the boundary zeros are
/// looked for on both sides, for those of φ that is real along a circle lie outside the polygon or inside by rounding
/// alone. Zeros nearer to each other, or to a pole, than a fiftieth of an edge count as one, of the sum of their
/// orders; so do a zero and a pole that cancel. Places where the boundary condition changes along a loop, branch points
/// of φ, are not among them, nor zeros on faces that the chart excludes. Of prescribed boundary values φ is what fits
/// the mesh best: its zeros well inside mean something, those within a few edges of the rim often do not.
///
/// In an atlas of a closed surface, whose parts lie side by side, likewise; where the orders do not come to −2χ, as of
/// a tabulated φ.
///
/// Of a tabulated φ, by what its argument turns from face to face around a vertex, less what the angles there turn, in
/// the surface's own metric. A simple zero inside is placed where the linear function through the faces around has
/// its own, anything else at a vertex; vertices next to each other count as one, of the sum of their orders. On
/// boundary loops along which φ is real, by the half turns there, with angles opened to a straight line (a marked
/// corner of a rectangle is a pole of dz²); on others not at all. Negative orders where there is no pole are noise of
/// the values, and are taken from the nearest zeros. A quad counts with its mean.
///
/// Where all of them are found, twice the orders inside and the orders on the boundary add up to −4χ of the surface if
/// φ is real along the boundary (Poincaré–Hopf on the double); the orders inside alone to what φ's argument turns along
/// the boundary if it is not.
/// @return by faces; none of φ = 0
/// @throw Error bad_option if φ is a table of another surface
std::vector<CriticalPoint> zeros_and_poles(const Surface& source, const QuadraticDifferential& phi);

}  // namespace beltrami
