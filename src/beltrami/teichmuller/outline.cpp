#include <beltrami/teichmuller/outline.h>

#include <beltrami/base/error.h>

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
        const SlackBoundary quarter = slacken(source, chart, boundary, 0.5 * kNoiseSlack);
        const double ratio = quarter.energy_after / quarter.energy_before;
        if (!(ratio < kNoisyRatio)) return {};
        const SlackBoundary half = slacken(source, chart, boundary, kNoiseSlack);
        return NoiseCost{kNoiseSlack, K_with(half.boundary), ratio};
    } catch (const Error& error) {  // the boundary values do not run forward: nothing is said about noise
        if (error.cause() != Cause::bad_boundary && error.cause() != Cause::bad_option) throw;
        return {};
    }
}

}  // namespace beltrami
