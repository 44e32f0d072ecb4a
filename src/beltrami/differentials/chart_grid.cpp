#include <beltrami/differentials/chart_grid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// A sample and the cell it lies in.
struct Place {
    std::uint64_t cell;
    int level;
    int sample;
    auto operator<=>(const Place&) const = default;
};

}  // namespace

ChartGrid chart_grid(const Chart& chart, double phase, const CellSize& size) {
    const int samples = static_cast<int>(chart.positions.size());
    std::vector<Place> places(samples);
    parallel_for(0, samples, [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const int level = chart.excluded[s] ? 0 : size.level(chart.positions[s]);
            const Complex z = std::polar(std::ldexp(1.0, level) / size.largest(), -phase) * chart.positions[s];
            // The offset keeps grid lines off the points of regular meshes.
            const auto i = static_cast<std::int32_t>(std::floor(z.real() + 0.38196601)),
                       j = static_cast<std::int32_t>(std::floor(z.imag() + 0.61803399));
            const auto shift = std::int64_t{1} << 31;
            places[s] = {(static_cast<std::uint64_t>(i + shift) << 32) | static_cast<std::uint64_t>(j + shift), level,
                         s};
        }
    });
    std::erase_if(places, [&](const Place& place) { return chart.excluded[place.sample] != 0; });
    std::sort(places.begin(), places.end());
    ChartGrid grid;
    grid.cell.assign(samples, -1);
    grid.samples.reserve(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i == 0 || std::tie(places[i].cell, places[i].level) != std::tie(places[i - 1].cell, places[i - 1].level)) {
            grid.offsets.push_back(static_cast<int>(i));
            grid.size.push_back(std::ldexp(size.largest(), -places[i].level));
        }
        grid.cell[places[i].sample] = static_cast<int>(grid.offsets.size()) - 1;
        grid.samples.push_back(places[i].sample);
    }
    grid.offsets.push_back(static_cast<int>(places.size()));
    return grid;
}

}  // namespace beltrami
