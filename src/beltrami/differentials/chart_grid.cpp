#include <beltrami/differentials/chart_grid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace beltrami {

ChartGrid chart_grid(const Chart& chart, double phase, double cell_size) {
    const int samples = static_cast<int>(chart.positions.size());
    const Complex turn = std::polar(1.0 / cell_size, -phase);
    std::vector<std::pair<std::uint64_t, int>> keyed;
    keyed.reserve(samples);
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        const Complex z = turn * chart.positions[s];
        // The offset keeps grid lines off the points of regular meshes.
        const auto i = static_cast<std::int32_t>(std::floor(z.real() + 0.38196601)),
                   j = static_cast<std::int32_t>(std::floor(z.imag() + 0.61803399));
        const auto shift = std::uint64_t{1} << 31;
        keyed.emplace_back((static_cast<std::uint64_t>(i + static_cast<std::int64_t>(shift)) << 32) |
                               static_cast<std::uint64_t>(j + static_cast<std::int64_t>(shift)),
                           s);
    }
    std::sort(keyed.begin(), keyed.end());
    ChartGrid grid;
    grid.cell.assign(samples, -1);
    grid.samples.reserve(keyed.size());
    for (std::size_t i = 0; i < keyed.size(); ++i) {
        if (i == 0 || keyed[i].first != keyed[i - 1].first) grid.offsets.push_back(static_cast<int>(i));
        grid.cell[keyed[i].second] = static_cast<int>(grid.offsets.size()) - 1;
        grid.samples.push_back(keyed[i].second);
    }
    grid.offsets.push_back(static_cast<int>(keyed.size()));
    return grid;
}

}  // namespace beltrami
