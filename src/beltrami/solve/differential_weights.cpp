#include <beltrami/solve/differential_weights.h>

#include <numeric>

namespace beltrami {

namespace {

constexpr double kFloor = 0.05;  // weight of the area beside that of |φ|

}  // namespace

std::vector<double> weights_of_differential(const std::vector<double>& areas, const Eigen::VectorXcd& phi) {
    double total = 0;
    for (std::size_t s = 0; s < areas.size(); ++s) total += areas[s] * std::abs(phi[static_cast<Eigen::Index>(s)]);
    const double floor = kFloor / std::accumulate(areas.begin(), areas.end(), 0.0), factor = total > 0 ? 1 / total : 0;
    std::vector<double> weights(areas.size());
    for (std::size_t s = 0; s < areas.size(); ++s)
        weights[s] = areas[s] * (factor * std::abs(phi[static_cast<Eigen::Index>(s)]) + floor);
    return weights;
}

}  // namespace beltrami
