#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

struct EvenDilatationOptions {
    int steps = 3;                  ///< Gauss-Newton steps, 0 to 3; of two each has more sweeps
    double anchor = 0.07;           ///< λ: how firmly the phase is held where |φ| is large (dilatation_spread.h)
    double outlier = 0.07;          ///< places where | |μ| − k | is above this are repaired one by one
    int most_patch_vertices = 300;  ///< such a place, with its surroundings, is no larger than this
    /// Called once per stage with its number and the energy; returning false cancels (Error cancelled).
    std::function<bool(int stage, double energy)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// New φ (#S) and k for a map; false if the old ones stay.
using CoefficientUpdate = std::function<bool(const Eigen::VectorXcd& map, Eigen::VectorXcd& phi, double& k)>;

struct EvenDilatation {
    Eigen::VectorXcd map;  ///< #V; the start, if nothing better was found
    Eigen::VectorXcd phi;  ///< #S and
    double k = 0;          ///< those of the last update, for which the energies are given
    bool improved = false;
    double start_energy = 0, energy = 0;  ///< E with Q = 0, see dilatation_spread.h
    int start_flipped = 0, flipped = 0;   ///< samples that are folded; never more than at the start
    int factorizations = 0;               ///< of the coupled system
    int sweeps = 0;
    int patch_steps = 0;
};

/// Evens |μ| out to the constant k of an almost extremal map, holding the phase of μ where |φ| is large: minimises the
/// spread E of dilatation_spread.h by damped Gauss-Newton steps on the whole map, Gauss-Seidel sweeps with a growing
/// penalty on outliers between them, and Levenberg-Marquardt on patches around what outliers remain.
///
/// A linear solve for μ = k conj(φ)/|φ| leaves noise of the mesh in |μ|, and E has about as many equations as unknowns,
/// so most of it can go. Without the anchor it would go at the price of the phase, and the Reich-Strebel bound of the
/// map would fall.
/// @param freedoms #V; what is not free keeps its value of @p start
/// @param start    #V, folded or not
/// @param k        0 ≤ k < 1
/// @param phi      #S quadratic differential in the samples' frames, of any scale; 0 where nothing is known
/// @param coefficient_update called up to once between stages; may be empty
/// @throw Error bad_option; bad_boundary if start is not finite; cancelled
EvenDilatation even_dilatation(const Surface& source, const std::vector<Freedom>& freedoms,
                               const Eigen::VectorXcd& start, double k, const Eigen::VectorXcd& phi,
                               const CoefficientUpdate& coefficient_update = {},
                               const EvenDilatationOptions& options = {});

}  // namespace beltrami
