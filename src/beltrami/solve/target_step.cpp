#include <beltrami/solve/target_step.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/solve/damping.h>

namespace beltrami {

namespace {

constexpr int kExpectedTargetFactorizations = 20;
constexpr double kShortestTargetStep = 1e-6;  // step length below which no step is taken
constexpr double kTargetShift = 1e-9, kLargestTargetShift = 1e-3;
constexpr double kHeldUpDamping = 1, kHeldUpFactor = 100;  // where no step is possible at all
constexpr double kNoticeableTargetDrift = 1e-2;
constexpr double kStiffening = 100, kSlackening = 4;  // of samples, at most in one step, and from step to step
constexpr double kStiff = 1.5;                        // by which stiffness a step counts as damped
constexpr double kBlocked = 0.05;                 // step length below which vertices of faces that would flip are held
constexpr double kFirstHold = 1, kTighter = 100;  // how much, and where they would again
constexpr double kAtRest = 100, kRest = 1e3;  // hold from which vertices do not move at all, and of those put to rest
constexpr double kCutThrough = 0.2;           // step length below which vertices are put to rest, and …
constexpr int kMostRests = 6;                 // … how often in one step
constexpr int kMostCorners = 4;

ElementSystem system_of(const Operators& operators, const std::vector<int>& place) {
    std::vector<int> nodes;
    nodes.reserve(operators.vertices.size());
    for (const int v : operators.vertices) nodes.push_back(place[v]);
    const int count = place.empty() ? 0 : *std::max_element(place.begin(), place.end()) + 1;
    return {operators.offsets, std::move(nodes), count, kExpectedTargetFactorizations, 2};
}

}  // namespace

TargetStep::TargetStep(const Operators& operators, const TargetMotion& motion)
    : operators_(operators),
      motion_(motion),
      place_(motion.indices_of_moving()),
      system_(system_of(operators, place_)),
      gradient_(system_.unknown_count()),
      stiffness_(Eigen::VectorXd::Ones(operators.sample_count())),
      hold_(Eigen::VectorXd::Zero(operators.vertex_count)) {}

TargetStep::Height TargetStep::height(const TargetEnergy& energy, const TargetMap& map) const {
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    Eigen::Vector2d sum = parallel_sum(operators_.sample_count(), Eigen::Vector2d(0, 0), [&](int first, int last) {
        Eigen::Vector2d part(0, 0);
        for (int s = first; s < last; ++s) {
            const ImageFrame frame = image_frame(operators_, s, points, normals);
            part[0] += energy.value(frame, s);
            part[1] += frame.upright ? 0 : 1;
        }
        return part;
    });
    return {sum[0], static_cast<int>(sum[1])};
}

void TargetStep::assemble(const TargetEnergy& energy, const TargetMap& map,
                          const std::vector<TargetMotion::Directions>& ways) {
    system_.clear();
    gradient_.setZero();
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    std::array<Complex, 2 * kMostCorners> v;
    std::array<double, static_cast<std::size_t>(kMostCorners) * (2 * kMostCorners + 1)> hessian;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const ImageFrame frame = image_frame(operators_, s, points, normals);
        const SampleTerm term = energy.term(frame, s);
        const double along = stiffness_[s] * term.along, across = stiffness_[s] * term.across;
        const auto stencil = operators_.stencil(s);
        const auto g = operators_.gradient(s);
        std::size_t entry = 0;
        for (std::size_t i = 0; i < 2 * stencil.size(); ++i) {
            const Complex b = frame.along(ways[stencil[i / 2]][i % 2]), to = g[i / 2];
            v[i] = 0.5 * b * (term.of_dzbar * to + term.of_dz * std::conj(to));
            if (const int node = place_[stencil[i / 2]]; node >= 0)
                gradient_[2 * node + static_cast<int>(i % 2)] += std::real(std::conj(term.gradient) * v[i]);
            for (std::size_t j = 0; j <= i; ++j)
                hessian[entry++] = along * v[i].real() * v[j].real() + across * v[i].imag() * v[j].imag();
        }
        system_.add(s, {hessian.data(), entry});
    }
    const std::vector<signed char>& unknowns = motion_.unknowns();
    for (std::size_t vertex = 0; vertex < unknowns.size(); ++vertex)  // what does not move across its curve
        if (unknowns[vertex] == 1) {
            const int unknown = 2 * place_[vertex];
            system_.add_to_diagonal(unknown + 1, std::max(system_.diagonal(unknown), 1e-300));
        }
}

/// Nothing where no shift of the diagonal makes the system definite.
std::optional<Positions> TargetStep::direction(const TargetEnergy& energy, const TargetMap& map) {
    const Eigen::VectorXd units = local_sizes(operators_, positions_of(map.points));
    std::vector<TargetMotion::Directions> ways;
    ways.reserve(place_.size());
    for (std::size_t v = 0; v < place_.size(); ++v) {
        TargetMotion::Directions way =
            motion_.directions(static_cast<int>(v), map, motion_.target().across(map.points[v]));
        for (Eigen::Vector3d& direction : way) direction *= units[static_cast<Eigen::Index>(v)];
        ways.push_back(way);
    }
    Eigen::VectorXd solution;
    for (double shift = kTargetShift;; shift *= 100) {
        assemble(energy, map, ways);
        for (std::size_t v = 0; v < place_.size(); ++v)
            if (const double hold = hold_[static_cast<Eigen::Index>(v)]; hold > 0 && place_[v] >= 0)
                for (const int unknown : {2 * place_[v], 2 * place_[v] + 1})
                    system_.add_to_diagonal(unknown, hold * system_.diagonal(unknown));
        system_.scale_diagonal(1 + shift + damping_);
        try {
            system_.factorize();
            solution = system_.solve(-gradient_);
            break;
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved) throw;
            if (shift >= kLargestTargetShift) return {};
        }
    }
    Positions motion = motion_along(place_, ways, solution);
    for (Eigen::Index v = 0; v < motion.rows(); ++v)
        if (hold_[v] >= kAtRest) motion.row(v).setZero();
    if (!energy.descends() || !motion_.unheld()) return motion;
    return motion_.target().without_drift(positions_of(map.points), std::move(motion), vertex_areas(operators_));
}

TargetStep::Taken TargetStep::step(TargetEnergy& energy, TargetMap& map, double largest) {
    energy.prepare(operators_, positions_of(map.points), normals_of(map.points));
    const Height before = height(energy, map);
    std::optional<Positions> motion = direction(energy, map);
    Taken taken;
    taken.energy = before.energy;
    taken.wanted = std::numeric_limits<double>::infinity();
    if (!motion) return taken;
    const double longest = motion->rowwise().norm().maxCoeff();
    taken.wanted = longest;
    const double whole = std::min(1.0, largest / longest);
    double length = whole;
    int rests = 0;
    TargetMap trial, rejected;
    while (length > kShortestTargetStep) {
        trial = motion_.moved(map, *motion, length);
        const Height after = height(energy, trial);
        const bool lower = !energy.descends() || after.energy < before.energy;
        if (!lower || after.flips > before.flips) {
            if (after.flips > before.flips) std::swap(rejected, trial);
            length *= 0.5;
            if (length < kCutThrough && after.flips > before.flips && rests < kMostRests &&
                put_to_rest(energy, map, rejected, *motion)) {
                ++rests;
                length = whole;
            }
            continue;
        }
        std::swap(map, trial);
        taken.length = length;
        taken.movement = length * motion->rowwise().norm().maxCoeff();
        taken.energy = after.energy;
        taken.fallen = before.energy > 0 ? 1 - after.energy / before.energy : 0;
        taken.damped = damping_ > kNoticeableTargetDrift || stiffness_.maxCoeff() > kStiff || drags();
        break;
    }
    if (!energy.descends()) return taken;
    if (!std::isfinite(energy.reach())) {
        damp(taken.length);
        return taken;
    }
    const TargetMap& from = taken.length > 0 ? trial : map;
    stiffness_ = (stiffness_ / kSlackening).cwiseMax(1);
    hold_ = (hold_.array() < kNoticeableTargetDrift).select(0, hold_ / kSlackening);
    damp(taken.length > 0 ? 1 : 0);  // what shorter steps would add to it stiffness adds to samples alone
    if (taken.length <= kNearlyFull) stiffen(energy, from, *motion);
    if (taken.length < kBlocked && !rejected.points.empty()) hold_flipped(from, rejected);
    return taken;
}

void TargetStep::stiffen(const TargetEnergy& energy, const TargetMap& from, const Positions& motion) {
    const Positions points = positions_of(from.points), normals = normals_of(from.points);
    parallel_for(0, operators_.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const ImageFrame frame = image_frame(operators_, s, points, normals);
            const SampleTerm term = energy.term(frame, s);
            const auto stencil = operators_.stencil(s);
            const auto g = operators_.gradient(s);
            Complex v = 0;
            for (std::size_t i = 0; i < stencil.size(); ++i)
                v += 0.5 * frame.along(motion.row(stencil[i]).transpose()) *
                     (term.of_dzbar * g[i] + term.of_dz * std::conj(g[i]));
            const double beyond = std::abs(v) / energy.reach();
            if (beyond > 1) stiffness_[s] *= kSlackening * std::min(beyond, kStiffening);
        }
    });
}

/// Of samples whose distortion does not foretell that they flip: faces cut through a mesh where it bends.
void TargetStep::hold_flipped(const TargetMap& from, const TargetMap& rejected) {
    const Positions points = positions_of(from.points), normals = normals_of(from.points),
                    moved = positions_of(rejected.points), moved_normals = normals_of(rejected.points);
    std::vector<char> blocks(static_cast<std::size_t>(hold_.size()), 0);
    for (int s = 0; s < operators_.sample_count(); ++s) {
        if (stiffness_[s] > 1 || image_frame(operators_, s, moved, moved_normals).upright ||
            !image_frame(operators_, s, points, normals).upright)
            continue;
        for (const int v : operators_.stencil(s)) blocks[v] = 1;
    }
    for (std::size_t v = 0; v < blocks.size(); ++v)
        if (double& hold = hold_[static_cast<Eigen::Index>(v)]; blocks[v]) hold = std::max(kTighter * hold, kFirstHold);
}

/// Of faces that cut through the target and would be on its other side: not they turn over, but the normals of their
/// corners, and their distortion foretells nothing. Those of their vertices that move are kept where they are.
bool TargetStep::put_to_rest(const TargetEnergy& energy, const TargetMap& from, const TargetMap& rejected,
                             Positions& motion) {
    if (!std::isfinite(energy.reach())) return false;
    const Positions points = positions_of(from.points), normals = normals_of(from.points),
                    moved = positions_of(rejected.points), moved_normals = normals_of(rejected.points);
    std::vector<char> resting(static_cast<std::size_t>(hold_.size()), 0);
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const ImageFrame after = image_frame(operators_, s, moved, moved_normals);
        if (after.upright) continue;
        const ImageFrame before = image_frame(operators_, s, points, normals);
        const bool turned_over = before.e1.cross(before.e2).dot(after.e1.cross(after.e2)) > 0;  // seen from outside
        if (!before.upright || turned_over) continue;
        for (const int v : operators_.stencil(s)) resting[v] = motion.row(v).isZero(0) ? 0 : 1;
    }
    bool any = false;
    for (std::size_t v = 0; v < resting.size(); ++v) {
        if (!resting[v]) continue;
        any = true;
        double& hold = hold_[static_cast<Eigen::Index>(v)];
        hold = std::max(kTighter * hold, kRest);
        motion.row(static_cast<Eigen::Index>(v)).setZero();
    }
    return any;
}

/// Whether vertices are held that do move. Those at rest stand where the next step would flip a face.
bool TargetStep::drags() const {
    return (hold_.array() > kNoticeableTargetDrift && hold_.array() < kAtRest).any();
}

void TargetStep::damp(double length) {
    if (length == 0)
        damping_ = std::max(kHeldUpFactor * damping_, kHeldUpDamping);
    else if (length < kShort)
        damping_ = std::max(kDampingFactor * damping_, kFirstDamping);
    else if (length > kNearlyFull)
        damping_ = damping_ / kDampingFactor < kLeastDamping ? 0 : damping_ / kDampingFactor;
}

int flipped_samples(const Operators& operators, const TargetMap& map) {
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    return parallel_sum(operators.sample_count(), 0, [&](int first, int last) {
        int count = 0;
        for (int s = first; s < last; ++s) count += !image_frame(operators, s, points, normals).upright;
        return count;
    });
}

}  // namespace beltrami
