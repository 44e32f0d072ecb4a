#include <beltrami/starts/untwisting.h>

#include <cmath>
#include <numbers>

#include <beltrami/solve/sliding_map_step.h>

namespace beltrami {

namespace {

constexpr int kSteps = 20;
/// Movements of the boundary, as part of its curve, at which the loops have turned.
constexpr double kSettled = 0.02;
/// Of the harmonic maps on the way.
constexpr double kTolerance = 1e-3;

}  // namespace

Untwisting untwisting(const Surface& source, const TargetModel& target, const SlidingStart& start, int outer_loop) {
    std::vector<SlidingLoop> loops = start.loops;
    hold_what_conformal_maps_move(loops, outer_loop, 0);
    SlidingBoundary boundary(source, std::move(loops));
    SlidingMapStep step(source, boundary, start.map, kSteps);
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source.operators.sample_count());
    std::vector<double> turns(start.loops.size(), 0);
    for (int i = 0; i < kSteps; ++i) {
        const std::vector<SlidingLoop> before = boundary.loops();
        step.solve(nu, kTolerance);
        for (std::size_t l = 0; l < turns.size(); ++l) {
            const std::vector<double>&from = before[l].parameters, &to = boundary.loops()[l].parameters;
            double sum = 0;
            for (std::size_t j = 0; j < from.size(); ++j)
                sum += std::remainder(target.angle(start.curves[l], to[j]) - target.angle(start.curves[l], from[j]),
                                      2 * std::numbers::pi);
            turns[before[l].loop] += sum / static_cast<double>(from.size());
        }
        if (step.movement() < kSettled) return {std::move(turns), step.factorization_count()};
    }
    return {{}, step.factorization_count()};
}

}  // namespace beltrami
