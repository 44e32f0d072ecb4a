#include <beltrami/starts/point_push.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltrami {

namespace {

/// Pushes, how far each goes and the disk it moves, as parts of the distance to what is not to move with it.
constexpr int kPushes = 500;
constexpr double kPush = 0.1, kReach = 0.9;

}  // namespace

bool push_points(const Surface& source, const std::vector<int>& vertices, const std::vector<Complex>& places,
                 Eigen::VectorXcd& map) {
    std::vector<int> rim;
    for (const auto& loop : source.topology.boundary_loops) rim.insert(rim.end(), loop.begin(), loop.end());
    const std::size_t n = vertices.size();
    for (int step = 0; step < kPushes; ++step) {
        std::vector<Complex> at(n), by(n);
        std::vector<double> reach(n, std::numeric_limits<double>::infinity());
        double largest = 0;  // of what is left, as part of the disk
        for (std::size_t i = 0; i < n; ++i) {
            at[i] = map[vertices[i]];
            by[i] = places[i] - at[i];
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j)
                if (j != i) reach[i] = std::min(reach[i], std::abs(at[j] - at[i]));
            for (const int v : rim) reach[i] = std::min(reach[i], std::abs(map[v] - at[i]));
            reach[i] *= kReach;
            if (!(reach[i] > 0)) return false;
            largest = std::max(largest, std::abs(by[i]) / reach[i]);
        }
        if (largest == 0) return true;
        const double part = std::min(1.0, kPush / largest);
        // One after another: each of these pushes is one-to-one.
        for (std::size_t i = 0; i < n; ++i) {
            const double square = reach[i] * reach[i];
            for (Eigen::Index v = 0; v < map.size(); ++v) {
                const double far = std::norm(map[v] - at[i]) / square;
                if (far < 1 && !source.topology.on_boundary[v]) map[v] += part * by[i] * (1 - far) * (1 - far);
            }
            if (part == 1) map[vertices[i]] = places[i];
        }
    }
    return false;
}

}  // namespace beltrami
