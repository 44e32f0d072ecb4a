#include <beltrami/teichmuller/outline.h>

#include <array>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// The outline of a disk in space with so many vertices is noisy where half of this slack leaves less than this part of
/// the energy (of smooth values .94 and more, of scans .23 to .8, of planted noise of a fifth of an edge .15).
constexpr double kNoiseSlack = 0.5, kNoisyRatio = 0.6;
constexpr std::size_t kNoisyRim = 60;
/// Blocks of edges have at least so much of the energy of smooth values (.90 to .99 where there are 113 edges and more;
/// with noise of a tenth of an edge .86 and less): then nothing is solved.
constexpr double kSmoothShare = 0.9;

}  // namespace

std::optional<NoiseCost> noise_of_outline(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                                          const std::function<double(const BoundaryCondition&)>& K_with) {
    if (source.topology.boundary_loops[0].size() < kNoisyRim) return {};
    try {
        if (energy_of_blocks(source, chart, boundary) > kSmoothShare) return {};
        // Both at once: that with half of the slack is all that is needed where the outline is not noisy.
        std::array<SlackBoundary, 2> moved;
        parallel_for_each(
            2, [&](int i) { moved[i] = slacken(source, chart, boundary, i == 0 ? 0.5 * kNoiseSlack : kNoiseSlack); });
        const double ratio = moved[0].energy_after / moved[0].energy_before;
        if (!(ratio < kNoisyRatio)) return {};
        return NoiseCost{kNoiseSlack, K_with(moved[1].boundary), ratio};
    } catch (const Error& error) {  // the boundary values do not run forward: nothing is said about noise
        if (error.cause() != Cause::bad_boundary && error.cause() != Cause::bad_option) throw;
        return {};
    }
}

}  // namespace beltrami
