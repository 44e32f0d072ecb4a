#include <beltrami/space/unrolled_map_step.h>

#include <cmath>

#include <beltrami/solve/differential_weights.h>

namespace beltrami {

namespace {

constexpr double kLeastStep = 1e-4;  // part of a step that is taken

}  // namespace

UnrolledMapStep::UnrolledMapStep(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                                 const std::vector<char>& fixed)
    : areas_(elements.operators.weights), problem_(source, elements, places, fixed), weights_(areas_) {}

void UnrolledMapStep::weigh(const Eigen::VectorXcd& phi) {
    weights_ = weights_of_differential(areas_, phi);
}

UnrolledMapStep::Height UnrolledMapStep::height(const BarrierEnergy& energy) const {
    const MapDerivatives map = problem_.derivatives();
    Height result;
    for (int s = 0; s < map.dz.size(); ++s) {
        const double value = energy.value(plane_frame(map.dz[s], map.dzbar[s]), s);
        if (std::isfinite(value))
            result.energy += value;
        else
            ++result.flipped;
    }
    return result;
}

/// Halves a step until it lowers the energy.
/// @return the part that was taken, 0: none
double UnrolledMapStep::go(const Eigen::VectorXcd& from, const Eigen::VectorXcd& way, const BarrierEnergy& energy,
                           const Height& before) {
    double part = 1;
    while (part > kLeastStep) {
        problem_.set_map(from + part * way);
        if (height(energy) < before) return part;
        part /= 2;
    }
    problem_.set_map(from);
    return 0;
}

void UnrolledMapStep::solve(const Eigen::VectorXcd& nu, double /*tolerance*/) {
    const BarrierEnergy energy(nu, weights_);
    const Eigen::VectorXcd from = problem_.map();
    const Height before = height(energy);
    problem_.solve(nu);
    last_length_ = go(from, problem_.map() - from, energy, before);
    if (last_length_ > 0 || before.flipped > 0) return;
    last_length_ = go(from, problem_.step(energy), energy, before);
}

}  // namespace beltrami
