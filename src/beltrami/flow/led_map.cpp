#include <beltrami/flow/led_map.h>

#include <algorithm>
#include <optional>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/flow/averaged_patches.h>
#include <beltrami/flow/unfolded_patches.h>
#include <beltrami/solve/target_step.h>

namespace beltrami {

namespace {

constexpr double kLongest = 0.1;    // of the image's diameter, the way of one round
constexpr double kShortest = 1e-3;  // part of the rest of the way below which a round does not go
constexpr int kRelaxations = 2;     // steps of least distortion after each round
constexpr int kMostHeldUp = 3;      // rounds in a row that go nowhere, relaxed between
constexpr double kArrived = 1e-12;  // of the image's diameter

/// #V flags of vertices that no edges join to any of some: of other components, or of no face.
std::vector<char> far_from(const Mesh& mesh, const std::vector<int>& vertices) {
    DisjointSets sets(mesh.vertex_count());
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) sets.join(mesh.faces[f][0], v);
    std::vector<char> reached(static_cast<std::size_t>(mesh.vertex_count()), 0), result(reached);
    for (const int v : vertices) reached[sets.find(v)] = 1;
    for (int v = 0; v < mesh.vertex_count(); ++v) result[v] = !reached[sets.find(v)];
    return result;
}

class Leading {
  public:
    Leading(const Surface& source, const Target& target, const TargetConstraints& constraints, TargetMap from,
            const TargetMap& to)
        : source_(source), to_(to), map_(std::move(from)) {
        leading_.fixed = constraints.fixed;
        for (const TargetConstraints::Slide& slide : constraints.sliding) leading_.fixed.push_back(slide.vertex);
        at_rest_ = far_from(source.mesh, leading_.fixed);
        held_.assign(at_rest_.size(), 0);
        for (const int v : leading_.fixed) held_[v] = at_rest_[v] = 1;
        map_.parameters.clear();
        motion_.emplace(source, target, leading_);
        step_.emplace(source.operators, *motion_);
        flips_ = flipped_samples(source.operators, map_);
        const Positions points = positions_of(map_.points);
        size_ = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    }

    LedMap run(int most_rounds) {
        LedMap result;
        const std::unique_ptr<GraphLaplacian> graph = graph_of(source_, at_rest_);
        for (int held_up = 0; result.rounds < most_rounds && held_up < kMostHeldUp; ++result.rounds) {
            Positions way = Positions::Zero(source_.mesh.vertex_count(), 3);
            for (const int v : leading_.fixed)
                way.row(v) = (to_.points[v].position - map_.points[v].position).transpose();
            const double farthest = way.rowwise().norm().maxCoeff();
            if (farthest < kArrived * size_) {
                result.arrived = true;
                break;
            }
            held_up = go(extended(*graph, way), farthest) ? 0 : held_up + 1;
            relax();
        }
        for (const int v : leading_.fixed) map_.points[v] = to_.points[v];
        map_.parameters = to_.parameters;
        result.flips = average_flipped_patches(source_, motion_->target(), held_, map_);
        if (result.flips > 0) result.flips = unfold_flipped_patches(source_, motion_->target(), held_, map_);
        result.map = std::move(map_);
        return result;
    }

  private:
    /// As far as nothing flips; false where that is not noticeable.
    bool go(const Positions& way, double farthest) {
        for (double length = std::min(1.0, kLongest * size_ / farthest); length > kShortest; length *= 0.5) {
            TargetMap trial = map_;
            for (std::size_t v = 0; v < trial.points.size(); ++v) {
                const Eigen::Vector3d by = length * way.row(static_cast<Eigen::Index>(v)).transpose();
                trial.points[v] = held_[v] && length == 1
                                      ? to_.points[v]
                                      : motion_->target().retract(map_.points[v].position + by, map_.points[v]);
            }
            const int flips = flipped_samples(source_.operators, trial);
            if (flips > flips_) continue;
            map_ = std::move(trial);
            flips_ = flips;
            return true;
        }
        return false;
    }

    void relax() {
        const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(source_.operators.sample_count());
        for (int i = 0; i < kRelaxations; ++i) {
            if (flips_ > 0) {
                ResidualEnergy energy(zero, source_.operators.weights);
                step_->step(energy, map_, kLongest * size_);
                flips_ = flipped_samples(source_.operators, map_);
            } else {
                BarrierEnergy energy(zero, source_.operators.weights);
                step_->step(energy, map_, kLongest * size_);
            }
        }
    }

    const Surface& source_;
    const TargetMap& to_;
    TargetConstraints leading_;
    TargetMap map_;
    std::vector<char> held_, at_rest_;  ///< #V; at rest are also vertices that none of the held ones moves
    std::optional<TargetMotion> motion_;
    std::optional<TargetStep> step_;
    int flips_ = 0;
    double size_ = 1;
};

}  // namespace

LedMap led_map(const Surface& source, const Target& target, const TargetConstraints& constraints, TargetMap from,
               const TargetMap& to, int most_rounds) {
    validate(constraints, source);
    const auto count = static_cast<std::size_t>(source.mesh.vertex_count());
    if (from.points.size() != count || to.points.size() != count || to.parameters.size() != constraints.sliding.size())
        throw Error(Cause::bad_option, "the maps belong to another source or to other constraints");
    return Leading(source, target, constraints, std::move(from), to).run(most_rounds);
}

}  // namespace beltrami
