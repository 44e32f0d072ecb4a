#pragma once

#include <beltrami/certificate/quadratic_map.h>

namespace beltrami {

struct SharpenedBoundOptions {
    int subdivisions = 0;          ///< midpoint subdivisions of the mesh before
    int most_triangles = 1000000;  ///< no finer mesh than that
    /// #V images of a piecewise linear map of the source with the same boundary values and no face turned over, which
    /// is put in where the quadratic one folds (mend()); empty: such a map is no use.
    Eigen::VectorXcd map = {};
};

/// A Reich-Strebel bound by a piecewise quadratic map.
struct SharpenedBound {
    ReichStrebel integrals;          ///< of the last map; not valid if there is no map with a positive determinant
    double lower = 0;                ///< the largest bound of the maps tried
    bool rigorous = false;           ///< up to floating point and quadrature; of the homotopy class of map
    QuadraticMap map;                ///< of the mesh below
    std::optional<Surface> refined;  ///< the mesh, if it is not the source: subdivided, or quads cut into triangles
    int triangles = 0;
    int factorizations = 0;
};

/// Reich & Strebel's bound holds for every quasiconformal map with the same boundary values, and a piecewise linear one
/// is not the best witness: its μ is constant on a face while conj(φ)/|φ| turns, which at K ~ 20 costs several per
/// cent. This takes the φ that was found, one f-step with piecewise quadratic maps (a second one where k turns out to
/// be another), and evaluates the bound there. Midpoints of boundary edges go to the midpoints of their images, so the
/// problem and K* are the same; the domain is that of the given polygons.
///
/// Quads are cut into triangles, in space a slightly different surface. The chart is evaluated where it is analytic,
/// else interpolated; on subdivided meshes that makes the bound no more rigorous.
/// @param chart, space, coefficients φ, as for reich_strebel
/// @param k where to start
/// @pre the whole boundary is prescribed, nothing slides
/// @throw Error not_solved
SharpenedBound sharpened_bound(const Surface& source, const BoundaryCondition& boundary, const Chart& chart,
                               const DifferentialSpace& space, const Eigen::VectorXcd& coefficients, double k,
                               const SharpenedBoundOptions& options = {});

}  // namespace beltrami
