#include <beltrami/flow/extremal_flow.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/target_step.h>

namespace beltrami {

namespace {

constexpr double kFloor = 0.05;         // of the weights: what belongs to the area
constexpr double kLongestMotion = 0.2;  // of the image's diameter
constexpr std::size_t kWatched = 8;     // steps over which the bracket has to change
constexpr double kLargestFactor = 4;    // by which a weight grows in a step
constexpr double kConformal = 1e-9;     // |μ| below which there is nothing to even out

class ExtremalFlow {
  public:
    ExtremalFlow(const Surface& source, const Target& target, const TargetConstraints& constraints, TargetMap start,
                 const ExtremalFlowOptions& options)
        : operators_(source.operators),
          options_(options),
          motion_(source, target, constraints),
          step_(source.operators, motion_),
          area_(source.operators.area()) {
        now_.map = std::move(start);
        now_.weights = operators_.weights;
        const Positions points = positions_of(now_.map.points);
        size_ = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    }

    ExtremalFlowMap run() {
        measure();
        best_ = now_;
        while (now_.iterations < options_.max_iterations) {
            if (now_.mean < kConformal) {
                best_.termination = Termination::converged;
                break;
            }
            weigh();
            const double length = advance();
            measure();
            brackets_.push_back({std::log(now_.K), std::log(now_.K_lower)});
            if (now_.K / now_.K_lower < best_.K / best_.K_lower) best_ = now_;
            if (options_.progress && !options_.progress(now_.iterations, now_.k))
                throw Error(Cause::cancelled, "cancelled after step " + std::to_string(now_.iterations));
            if (settled()) {
                best_.termination = length > 0 ? Termination::converged : Termination::unconfirmed;
                break;
            }
        }
        best_.iterations = now_.iterations;
        best_.factorizations = step_.factorization_count();
        return std::move(best_);
    }

  private:
    /// Weights times |μ| around their samples, as parts of its mean by them.
    void weigh() {
        Eigen::VectorXd sums = Eigen::VectorXd::Zero(operators_.vertex_count), areas = sums;
        for (int s = 0; s < operators_.sample_count(); ++s)
            for (const int v : operators_.stencil(s)) {
                sums[v] += operators_.weights[s] * abs_mu_[s];
                areas[v] += operators_.weights[s];
            }
        for (int s = 0; s < operators_.sample_count(); ++s) {
            const auto stencil = operators_.stencil(s);
            double around = 0;
            for (const int v : stencil) around += sums[v] / areas[v];
            around /= static_cast<double>(stencil.size());
            now_.weights[s] *= std::min(around / now_.mean, kLargestFactor);
        }
        const double total = std::accumulate(now_.weights.begin(), now_.weights.end(), 0.0);
        for (std::size_t s = 0; s < now_.weights.size(); ++s)
            now_.weights[s] = (1 - kFloor) * now_.weights[s] * area_ / total + kFloor * operators_.weights[s];
    }

    /// One step; the part of it that was taken.
    double advance() {
        BarrierEnergy energy(Eigen::VectorXcd::Zero(operators_.sample_count()), now_.weights);
        ++now_.iterations;
        return step_.step(energy, now_.map, kLongestMotion * size_).length;
    }

    void measure() {
        const Eigen::VectorXcd mu =
            beltrami_coefficient(operators_, positions_of(now_.map.points), normals_of(now_.map.points));
        abs_mu_ = mu.cwiseAbs();
        double total = 0, above = 0, below = 0, mean = 0, squares = 0;
        for (int s = 0; s < operators_.sample_count(); ++s) {
            const double m = abs_mu_[s], by = now_.weights[s] * m / (1 - m * m), K = dilatation(m);
            total += by;
            above += by * K;
            below += by / K;
            mean += by * m;
            squares += by * m * m;
        }
        now_.mean = now_.standard_deviation = 0;
        now_.K = now_.K_lower = 1;
        if (total > 0) {
            now_.mean = mean / total;
            now_.standard_deviation = std::sqrt(std::max(0.0, squares / total - now_.mean * now_.mean));
            now_.K = std::sqrt(above / below);
            now_.K_lower = total / below;
        }
        now_.k = k_of(now_.K);
    }

    bool settled() const {
        if (brackets_.size() <= kWatched) return false;
        const Eigen::Array2d now = brackets_.back();
        return std::all_of(
            brackets_.end() - static_cast<std::ptrdiff_t>(kWatched) - 1, brackets_.end(),
            [&](const Eigen::Array2d& before) { return ((before - now).abs() <= options_.tolerance * now).all(); });
    }

    const Operators& operators_;
    const ExtremalFlowOptions& options_;
    TargetMotion motion_;
    TargetStep step_;
    double area_, size_ = 1;
    Eigen::VectorXd abs_mu_;                ///< #S of the map
    std::vector<Eigen::Array2d> brackets_;  ///< log K and log K_lower after every step
    ExtremalFlowMap now_, best_;
};

}  // namespace

void ExtremalFlowOptions::validate() const {
    if (!(tolerance >= 0)) throw Error(Cause::bad_option, "the tolerance is negative");
    if (max_iterations < 1) throw Error(Cause::bad_option, "at least one iteration is needed");
}

ExtremalFlowMap extremal_flow(const Surface& source, const Target& target, const TargetConstraints& constraints,
                              TargetMap start, const ExtremalFlowOptions& options) {
    options.validate();
    beltrami::validate(constraints, source);
    if (start.points.size() != static_cast<std::size_t>(source.mesh.vertex_count()) ||
        start.parameters.size() != constraints.sliding.size())
        throw Error(Cause::bad_option, "the start belongs to another source or to other constraints");
    if (const int flips = flipped_samples(source.operators, start); flips > 0)
        throw Error(Cause::bad_option, "a barrier against flips needs a start without them; " + std::to_string(flips) +
                                           " samples are flipped");
    return ExtremalFlow(source, target, constraints, std::move(start), options).run();
}

}  // namespace beltrami
