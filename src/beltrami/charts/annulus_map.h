#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// The two harmonic functions of an annulus-like surface, each by one linear solve of #V unknowns.
struct AnnulusPotentials {
    Eigen::VectorXd u;  ///< #V, 0 on the outer loop and 1 on the other one
    Eigen::VectorXd v;  ///< #V, grows by 1 when going around with the outer loop's direction; its values modulo 1
    /// ∫|∇u|² and ∫|∇v|²: the capacity between the loops of the polyhedron lies between 1/v_energy and u_energy.
    double u_energy = 0, v_energy = 0;
    /// #loops: growth of v from every vertex of a boundary loop to the next one.
    std::vector<std::vector<double>> increments;
};
/// @pre one component of genus 0 with two boundary loops
/// @throw Error not_solved
AnnulusPotentials annulus_potentials(const Surface& surface, int outer_loop);

/// The conformal map of an annulus-like surface to a round annulus, @p outer_loop on the unit circle and the other loop
/// on a circle about 0: exp(−2π(u − i v)/T), u harmonic, 0 on the outer loop and 1 on the other one, v its conjugate
/// with the period T, each by one linear solve of #V unknowns. T is the geometric mean of what u and v give for it,
/// whose errors have opposite signs. The discretisation error is of second order.
/// @return #V positions
/// @pre one component of genus 0 with two boundary loops
/// @throw Error not_solved
Eigen::VectorXcd annulus_map(const Surface& surface, int outer_loop);

/// The same annulus as a strip of the plane with the period 2π: w = 2π(v + iu/T), −i times the logarithm of the round
/// one. Of a cylinder that is the plane into which it is unrolled, where its chart is exact; in the ring of radii
/// e^{−Y} and 1 a face of width h has errors of h.
struct AnnulusStrip {
    Eigen::VectorXcd corners;  ///< #corners: where each face lies, as a whole (make_atlas)
    double height = 0;         ///< Y; the outer loop lies at 0
};
/// @pre one component of genus 0 with two boundary loops, every edge of less than half a turn
/// @throw Error not_solved
AnnulusStrip annulus_strip(const Surface& surface, int outer_loop);

}  // namespace beltrami
