#include <beltrami/teichmuller/extremal_options.h>

#include <cmath>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

constexpr double kTolerance = 1e-8;
/// Where boundaries slide the error of the mesh is far larger; k, of second order in the direction of φ, settles to
/// this part of it.
constexpr double kSlidingTolerance = 1e-6, kToleranceOfK = 0.01;

}  // namespace

void ExtremalOptions::validate() const {
    IterationOptions::validate();
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(growth > 0, "growth must be positive");
    demand(cluster_count >= 100, "cluster_count must be at least 100");
    demand(slack >= 0 && std::isfinite(slack), "slack must be finite and not negative");
    demand(target_edge_length >= 0 && std::isfinite(target_edge_length),
           "the target's edge length must be positive, or 0");
    for (const double turn : start_turns) demand(std::isfinite(turn), "a start turn is not a number");
}

HamiltonIteration::Options iteration_options(const ExtremalOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = result.k_tolerance = options.tolerance > 0 ? options.tolerance : kTolerance;
    result.max_iterations = options.max_iterations;
    result.growth = options.growth;
    result.anderson_window = options.anderson_window;
    result.progress = options.progress;
    return result;
}

HamiltonIteration::Options sliding_iteration_options(const ExtremalOptions& options) {
    HamiltonIteration::Options result = iteration_options(options);
    if (!(options.tolerance > 0)) result.tolerance = kSlidingTolerance;
    result.k_tolerance = kToleranceOfK * result.tolerance;
    result.grow_first = result.grow_last = false;
    return result;
}

const char* to_string(ExtremalOptions::Space space) {
    switch (space) {
        case ExtremalOptions::Space::automatic:
            return "automatic";
        case ExtremalOptions::Space::laurent:
            return "laurent";
        case ExtremalOptions::Space::projection:
            return "projection";
        case ExtremalOptions::Space::one_form_squares:
            return "one_form_squares";
    }
    return "";
}

}  // namespace beltrami
