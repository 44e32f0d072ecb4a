#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// z exp(q(z)), q = Σ_h Σ_j a_hj t_h^j − conj(a_hj) s_h^j with t_h = r_h/(z − c_h) and its mirror image in the unit
/// circle s_h = r_h z/(1 − conj(c_h) z): analytic outside the holes, and the unit circle goes to itself exactly as Re q
/// = 0 there.
struct CircleMap {
    struct Pole {
        Complex centre;
        double radius;
        Eigen::VectorXcd coefficients;  ///< a_h1, a_h2, …
    };
    std::vector<Pole> poles;

    /// Value and derivative.
    std::array<Complex, 2> operator()(Complex z) const;
};

/// An analytic map of a domain inside the unit circle that makes its holes rounder.
struct HoleRounding {
    std::vector<CircleMap> steps;  ///< one after the other; none if nothing was won
    double ratio_before = 1;  ///< largest over smallest distance of a rim vertex from the centre, of the worst hole
    double ratio = 1;         ///< the same after the steps

    /// Value and derivative.
    std::array<Complex, 2> operator()(Complex z) const;
};

struct HoleRoundingOptions {
    double wanted_ratio = 1.05;  ///< stop when every hole is as round as that
    int max_steps = 15;
    int terms = 10;  ///< powers a hole has, at most
};

/// Newton's method for a circle domain, after Wegmann: in each step the linearised condition |F − C_h| = R_h on every
/// rim, C_h and R_h unknown, is solved by least squares over the vertices of the rims, and the map, held to |F′ − 1| ≤
/// ½ to first order, is composed with those before. Deviations: the unknowns are series with poles in the holes instead
/// of boundary values, and the outer circle is kept exactly by symmetry. Only the rims are used, so a step costs
/// little. Source: Wegmann 2005, "Methods for numerical conformal mapping" (Handbook of Complex Analysis 2).
/// @param rims of the holes, inside the unit circle
HoleRounding round_holes(std::vector<std::vector<Complex>> rims, const HoleRoundingOptions& options = {});

}  // namespace beltrami
