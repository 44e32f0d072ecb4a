#pragma once

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/space/least_squares_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct UniformOptions {
    int max_iterations = 40;
    double tolerance = 1e-3;   ///< stop when the coefficients change by less, mean over the faces
    bool line_search = false;  ///< go to the new coefficient only as far as QC(f) falls (step 4 of Algorithm 3)
    int smoothing_passes = 1;  ///< between two solves
    Progress progress;         ///< with the mean of |μ|

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct UniformMap {
    Positions map;            ///< #V×3
    Positions first;          ///< the least-squares conformal map with which it begins
    Eigen::VectorXcd wanted;  ///< #F coefficient of the last solve
    int solves = 0;
    bool converged = false;
};

/// The QC iteration of Gruber and Aulisa 2022 (Algorithm 3, their TQCM): from the least-squares conformal map, |μ| of
/// every face is replaced by the mean over all faces, its argument smoothed by way of the edges, and the least-squares
/// map with that coefficient solved for, again and again. Corrected: the argument goes from a face to an edge at the
/// angle θ in its frame by e^{−2iθ} and back by e^{2iθ}, so that constant fields stay, and the phases are divided by
/// their own absolute values. Folds are not excluded, and a limit need not be extremal.
/// @throw Error bad_option, not_solved, cancelled
UniformMap uniform_map(LeastSquaresMap& problem, const Mesh& source, const UniformOptions& options = {});

/// One pass of the smoothing: mean |μ| with the argument smoothed over the edges.
/// @param mu #F, in the frames of the elements
Eigen::VectorXcd smoothed_over_edges(const CornerElements& elements, const Mesh& mesh, const Eigen::VectorXcd& mu,
                                     int passes = 1);

}  // namespace beltrami
