#pragma once

#include <functional>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Called once per iteration with its number, from 1, and what the iteration makes small or settles (k, an energy);
/// returning false cancels (Error cancelled).
using Progress = std::function<bool(int iteration, double value)>;

/// What all iterations are told.
struct IterationOptions {
    /// Stop when what the iteration settles changes by less than this; 0: what suits the problem.
    double tolerance = 0;
    int max_iterations = 60;  ///< linear solves
    int anderson_window = 5;  ///< of the acceleration; 0: plain iteration
    Progress progress = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

}  // namespace beltrami
