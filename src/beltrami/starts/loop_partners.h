#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/plane/disk_moebius.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami {

/// Which curve each boundary loop goes to, and the source's circle domain brought near the target's model.
struct LoopPartners {
    std::vector<int> curves;         ///< of every loop
    DiskMoebius move;                ///< that fits holes and marks best; a rotation if waypoints are given
    Eigen::VectorXcd vertices;       ///< #V places of the chart, moved
    std::vector<RoundHole> circles;  ///< of every loop, moved
};

/// Pairs the loops, as wanted.loops has them or matched (circle_matching.h), and moves the source's circle domain by
/// the best Möbius map: conformal copies of a source get the same start. Where waypoints say how the holes go on it is
/// only turned, as it is where the faces are too large for the Möbius map to keep their sides.
/// @param known pairs (loop, curve) of holes that others are to be matched beside; not used where wanted.loops has them
/// @throw Error bad_boundary, bad_option
LoopPartners loop_partners(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                           const Correspondence& wanted, std::span<const std::array<int, 2>> known = {});

/// The same partners with the source's circle domain only turned, where no places are marked.
LoopPartners turned(const LoopPartners& partners, const CircleDomainChart& chart, const TargetModel& target,
                    const Correspondence& wanted);

}  // namespace beltrami
