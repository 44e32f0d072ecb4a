#include <beltrami/charts/uniformization.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/plane/disk_moebius.h>

namespace beltrami {

namespace {

/// The holes with that of a loop first.
std::vector<RoundHole> ordered(std::vector<RoundHole> holes, std::optional<int> centre) {
    if (!centre) return holes;
    const auto first = std::find_if(holes.begin(), holes.end(), [&](const RoundHole& h) { return h.loop == *centre; });
    if (first == holes.end())
        throw Error(Cause::bad_option, "there is no hole of boundary loop " + std::to_string(*centre),
                    "name a boundary loop other than the outer one");
    std::rotate(holes.begin(), first, first + 1);
    return holes;
}

/// Puts the rims on their circles again, which rounding has left.
void snap(const Surface& source, const CircleDomainChart& chart, Uniformization& result) {
    std::vector<RoundHole> circles = result.holes;
    circles.push_back({chart.outer_loop(), 0, 1});
    for (const RoundHole& circle : circles)
        for (const int v : source.topology.boundary_loops[circle.loop]) {
            const Complex from = result.map[v] - circle.centre;
            result.map[v] = circle.centre + circle.radius * from / std::abs(from);
        }
}

}  // namespace

Uniformization uniformization(const Surface& source, int outer_loop, std::optional<int> centre) {
    return uniformization(source, circle_domain_chart(source, outer_loop), centre);
}

Uniformization uniformization(const Surface& source, CircleDomainChart chart, std::optional<int> centre) {
    Uniformization result;
    result.holes = ordered(chart.holes, centre);
    DiskMoebius move = result.holes.empty() ? DiskMoebius{} : centring(result.holes[0]);
    const Complex ahead = result.holes.size() > 1
                              ? move(result.holes[1]).centre
                              : move(chart.chart.vertices[source.topology.boundary_loops[chart.outer_loop()][0]]);
    // Two disjoint circles, one around 0: the other's centre is away from it.
    move.rotation = -std::arg(ahead);
    result.map = move(chart.chart.vertices);
    for (RoundHole& hole : result.holes) hole = move(hole);
    if (!result.holes.empty()) {
        result.holes[0].centre = 0;
        result.moduli.push_back(result.holes[0].radius);
    }
    for (std::size_t h = 1; h < result.holes.size(); ++h) {
        RoundHole& hole = result.holes[h];
        if (h == 1) hole.centre = hole.centre.real();
        result.moduli.push_back(hole.centre.real());
        if (h > 1) result.moduli.push_back(hole.centre.imag());
        result.moduli.push_back(hole.radius);
    }
    snap(source, chart, result);
    if (result.holes.size() == 1) result.module = -std::log(result.holes[0].radius) / (2 * std::numbers::pi);
    result.chart = std::move(chart);
    return result;
}

}  // namespace beltrami
