#include <beltrami/differentials/chart_grid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// A sample and the cell it lies in.
struct Place {
    std::int32_t i, j;
    int level;
};

/// A sample with what it is sorted by.
struct Keyed {
    std::uint64_t key;
    int sample;
};

/// Sorts by key, samples of equal keys as they stand: by groups of bits, the lowest first.
void sort_by_key(std::vector<Keyed>& keyed, std::uint64_t largest) {
    constexpr int kBits = 11, kGroups = 1 << kBits;
    std::vector<Keyed> sorted(keyed.size());
    for (int shift = 0; shift < 64 && (largest >> shift) != 0; shift += kBits) {
        std::array<std::size_t, kGroups + 1> place{};
        const auto group = [shift](const Keyed& k) { return (k.key >> shift) & (kGroups - 1); };
        for (const Keyed& k : keyed) ++place[group(k) + 1];
        std::partial_sum(place.begin(), place.end(), place.begin());
        for (const Keyed& k : keyed) sorted[place[group(k)]++] = k;
        keyed.swap(sorted);
    }
}

}  // namespace

ChartGrid chart_grid(const Chart& chart, double phase, const CellSize& size) {
    const int samples = static_cast<int>(chart.positions.size());
    std::vector<Place> places(samples);
    parallel_for(0, samples, [&](int begin, int end) {
        const Complex turn = std::polar(1.0, -phase);
        for (int s = begin; s < end; ++s) {
            const int level = chart.excluded[s] ? 0 : size.level(chart.positions[s]);
            const Complex z = std::ldexp(1.0, level) / size.largest() * turn * chart.positions[s];
            // The offset keeps grid lines off the points of regular meshes.
            places[s] = {static_cast<std::int32_t>(std::floor(z.real() + 0.38196601)),
                         static_cast<std::int32_t>(std::floor(z.imag() + 0.61803399)), level};
        }
    });
    Place least{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(), 0};
    Place most{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(), 0};
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        least = {std::min(least.i, places[s].i), std::min(least.j, places[s].j), 0};
        most = {std::max(most.i, places[s].i), std::max(most.j, places[s].j), std::max(most.level, places[s].level)};
    }
    // Row by row, in a row column by column, and there by level.
    const auto above = [](std::int32_t a, std::int32_t b) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(a) - b);
    };
    const std::uint64_t columns = most.j < least.j ? 1 : above(most.j, least.j) + 1,
                        levels = static_cast<std::uint64_t>(most.level) + 1;
    std::vector<Keyed> keyed;
    keyed.reserve(static_cast<std::size_t>(samples));
    std::uint64_t largest = 0;
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        const Place& p = places[s];
        const std::uint64_t key =
            (above(p.i, least.i) * columns + above(p.j, least.j)) * levels + static_cast<std::uint64_t>(p.level);
        largest = std::max(largest, key);
        keyed.push_back({key, s});
    }
    sort_by_key(keyed, largest);
    ChartGrid grid;
    grid.cell.assign(samples, -1);
    grid.samples.reserve(keyed.size());
    for (std::size_t i = 0; i < keyed.size(); ++i) {
        const int s = keyed[i].sample;
        if (i == 0 || keyed[i].key != keyed[i - 1].key) {
            grid.offsets.push_back(static_cast<int>(i));
            grid.size.push_back(std::ldexp(size.largest(), -places[s].level));
        }
        grid.cell[s] = static_cast<int>(grid.offsets.size()) - 1;
        grid.samples.push_back(s);
    }
    grid.offsets.push_back(static_cast<int>(keyed.size()));
    return grid;
}

}  // namespace beltrami
