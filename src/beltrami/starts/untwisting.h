#pragma once

#include <vector>

#include <beltrami/starts/sliding_start.h>

namespace beltrami {

struct Untwisting {
    std::vector<double> turns;  ///< radians on the model's circles, counter-clockwise, one per loop of the source;
                                ///< empty where nothing settles
    int factorizations = 0;
};

/// How far every loop turns, on average, until the energy of the harmonic map whose boundary slides is least. A start
/// that is turned so is not twisted near its loops: without that, loops that start 2 rad off cost up to 104 iterations
/// instead of 19, because the φ of a twisted map hardly lets go of the twist.
///
/// Folds on the way do no harm, only the boundary is looked at.
/// @param start harmonic, with no marks
Untwisting untwisting(const Surface& source, const TargetModel& target, const SlidingStart& start, int outer_loop);

}  // namespace beltrami
