#pragma once

#include <functional>

#include <beltrami/space/uniform_map.h>

namespace beltrami {

/// The QC iteration of maps of any kind: of what it does with them, between two solves.
struct UniformSteps {
    std::function<void(const Eigen::VectorXcd& mu)> solve;  ///< #S, the map with that coefficient
    std::function<Eigen::VectorXcd()> coefficients;         ///< #F of the map, those of flipped faces cut off
    std::function<double(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to)> best_step;  ///< #S; 0 … 1
};

struct UniformRun {
    Eigen::VectorXcd wanted;  ///< #F coefficient of the last solve
    int solves = 0;
    bool converged = false;
};

/// @pre the first solve, with the coefficient 0, is done
UniformRun iterate_to_uniform(const CornerElements& elements, const Mesh& source, const UniformSteps& steps,
                              const UniformOptions& options);

/// Means over the samples of faces, of which none is larger than what counts at most.
/// @param mu #S; what is not finite counts as flipped
Eigen::VectorXcd cut_off_means(const Operators& operators, Eigen::VectorXcd mu);

}  // namespace beltrami
