#include <beltrami/teichmuller/hamilton_options.h>

#include <algorithm>

namespace beltrami {

namespace {

constexpr double kTolerance = 1e-8;
/// On a disk without singularities: k, of second order in the direction of φ, is then exact to 1e-8, and the map to far
/// less than the error of the mesh.
constexpr double kSmoothTolerance = 1e-5;
/// Larger spaces are tried there to this change of φ: k is then exact to a hundredth of what lets them grow.
constexpr double kSmoothGrowingStep = 3e-4;
/// Acceleration begins there as soon as φ changes by less than itself.
constexpr double kAccelerateSmoothBelow = 1;
/// Where boundaries slide the error of the mesh is far larger; k, of second order in the direction of φ, settles to
/// this part of it.
constexpr double kSlidingTolerance = 1e-6, kToleranceOfK = 0.01;

}  // namespace

HamiltonIteration::Options iteration_options(const ExtremalOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = result.k_tolerance = options.tolerance > 0 ? options.tolerance : kTolerance;
    result.max_iterations = options.max_iterations;
    result.growth = options.growth;
    result.anderson_window = options.anderson_window;
    result.progress = options.progress;
    return result;
}

void adapt_to_smooth(const ExtremalOptions& options, HamiltonIteration::Options& how) {
    how.accelerate_below = kAccelerateSmoothBelow;
    how.growing_step = kSmoothGrowingStep;
    if (!(options.tolerance > 0)) how.tolerance = std::max(how.tolerance, kSmoothTolerance);
}

HamiltonIteration::Options sliding_iteration_options(const ExtremalOptions& options) {
    HamiltonIteration::Options result = iteration_options(options);
    if (!(options.tolerance > 0)) result.tolerance = kSlidingTolerance;
    result.k_tolerance = kToleranceOfK * result.tolerance;
    result.grow_first = result.grow_last = false;
    return result;
}

}  // namespace beltrami
