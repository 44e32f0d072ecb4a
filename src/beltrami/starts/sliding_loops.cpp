#include <beltrami/starts/sliding_loops.h>

#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// A loop's image encloses at least this part of what it could.
constexpr double kLeastArea = 0.5;

/// The part of a disk's area that a polygon of n corners can enclose. Of all convex curves ellipses leave the largest
/// inscribed polygon the least part (E. Sas, Compositio Math. 6, 1939).
double inscribed_part(std::size_t corners) {
    const double turn = 2 * std::numbers::pi / static_cast<double>(corners);
    return std::sin(turn) / turn;
}

double enclosed_area(const std::vector<int>& loop, const Eigen::VectorXcd& map) {
    double twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Complex a = map[loop[i]], b = map[loop[(i + 1) % loop.size()]];
        twice += std::imag(std::conj(a) * b);
    }
    return 0.5 * twice;
}

}  // namespace

std::vector<LoopOnto> loops_onto(const Surface& source, const SlidingBoundary& boundary, const std::vector<int>& curves,
                                 const Eigen::VectorXcd& map) {
    std::vector<LoopOnto> result;
    for (const SlidingLoop& sliding : boundary.loops()) {
        const double area = enclosed_area(source.topology.boundary_loops[sliding.loop], map);
        const double whole = sliding.curve.counter_clockwise() ? sliding.curve.area() : -sliding.curve.area();
        result.push_back({sliding.loop, curves[sliding.loop], sliding.parameters, area / whole});
    }
    return result;
}

void require_not_collapsed(const std::vector<LoopOnto>& loops) {
    for (const LoopOnto& loop : loops)
        if (const double most = inscribed_part(loop.parameters.size()); !(loop.area_ratio > kLeastArea * most))
            throw Error(Cause::not_solved,
                        "boundary loop " + std::to_string(loop.loop) + " has collapsed: its image encloses " +
                            std::to_string(100 * loop.area_ratio) + " % of what its curve does, where its " +
                            std::to_string(loop.parameters.size()) + " vertices could enclose " +
                            std::to_string(100 * most) + " %",
                        "give the loop more vertices, or lead the start there by waypoints");
}

}  // namespace beltrami
