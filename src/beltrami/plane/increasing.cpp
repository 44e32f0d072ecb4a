#include <beltrami/plane/increasing.h>

#include <algorithm>

namespace beltrami {

void make_increasing(std::vector<double>& values, double period, const std::vector<double>& arc) {
    struct Pool {
        double sum;
        std::size_t first, count;
        double mean() const { return sum / static_cast<double>(count); }
    };
    // Three times around: what the second turn gets does not depend on where the loop starts.
    const std::size_t n = values.size();
    const double total = arc.back();
    const auto turn = [&](std::size_t i) {
        const std::size_t round = i / n;
        return static_cast<double>(round) - 1;
    };
    const auto value = [&](std::size_t i) { return values[i % n] + turn(i) * period; };
    const auto place = [&](std::size_t i) { return arc[i % n] + turn(i) * total; };
    std::vector<Pool> pools;
    for (std::size_t i = 0; i < 3 * n; ++i) {
        pools.push_back({value(i), i, 1});
        while (pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean()) {
            const Pool last = pools.back();
            pools.pop_back();
            pools.back().sum += last.sum;
            pools.back().count += last.count;
        }
    }
    std::vector<double> result = values;
    for (std::size_t p = 1; p + 1 < pools.size(); ++p) {
        const std::size_t first = pools[p].first, last = first + pools[p].count - 1;
        if (first == last || last < n || first >= 2 * n) continue;
        const double low = 0.5 * (pools[p - 1].mean() + pools[p].mean()),
                     high = 0.5 * (pools[p].mean() + pools[p + 1].mean());
        for (std::size_t i = std::max(first, n); i <= std::min(last, 2 * n - 1); ++i)
            result[i - n] = low + (high - low) * (place(i) - place(first) + 1e-3 * total) /
                                      (place(last) - place(first) + 2e-3 * total);
    }
    values = std::move(result);
}

void raise_to_neighbours(std::vector<double>& increments, double part) {
    constexpr std::size_t kAround = 4;
    const std::vector<double> given = increments;
    const std::size_t n = given.size();
    for (std::size_t i = 0; i < n; ++i) {
        double sum = given[i];
        std::size_t count = 1;
        for (std::size_t away = 1; 2 * away <= n && (away <= kAround || !(sum > 0)); ++away) {
            sum += given[(i + away) % n] + given[(i + n - away) % n];
            count += 2;
        }
        increments[i] = std::max(given[i], part * sum / static_cast<double>(count));
    }
}

}  // namespace beltrami
