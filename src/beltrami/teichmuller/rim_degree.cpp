#include <beltrami/teichmuller/rim_degree.h>

#include <algorithm>
#include <numbers>

namespace beltrami {

namespace {

constexpr double kEdgesPerTurn = 5;
constexpr int kLeastDegree = 4;
constexpr int kEdgesPerPower = 6;
constexpr int kLeastPower = 3, kMostPower = 16;

}  // namespace

int degree_of_rim(const Surface& source, const Chart& chart) {
    double length = 0, squares = 0;
    const auto& rim = source.topology.boundary_loops[chart.outer_loop];
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const double edge = std::abs(chart.vertices[rim[(i + 1) % rim.size()]] - chart.vertices[rim[i]]);
        length += edge;
        squares += edge * edge;
    }
    return std::max(kLeastDegree, static_cast<int>(2 * std::numbers::pi / (kEdgesPerTurn * squares / length)));
}

int powers_of_hole(const Surface& source, int loop) {
    return std::clamp(static_cast<int>(source.topology.boundary_loops[loop].size()) / kEdgesPerPower, kLeastPower,
                      kMostPower);
}

}  // namespace beltrami
