#pragma once

#include <beltrami/teichmuller/extremal_options.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

/// What the options say about the iteration where boundary values are prescribed.
HamiltonIteration::Options iteration_options(const ExtremalOptions& options);
/// Changes them for a disk on which φ has no singularities: steps are accelerated from the first on.
void adapt_to_smooth(const ExtremalOptions& options, HamiltonIteration::Options& how);
/// The same where boundaries slide: the space of differentials does not grow.
HamiltonIteration::Options sliding_iteration_options(const ExtremalOptions& options);

}  // namespace beltrami
