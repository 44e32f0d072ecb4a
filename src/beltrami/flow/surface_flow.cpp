#include <beltrami/flow/surface_flow.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/flow/averaged_patches.h>
#include <beltrami/flow/coefficient_error_sum.h>
#include <beltrami/flow/unfolded_patches.h>
#include <beltrami/solve/image_frame.h>
#include <beltrami/solve/quasiconformal_map.h>
#include <beltrami/solve/target_step.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr double kLongestFlowMotion = 0.2;  // of the image's diameter
constexpr double kWhole = 0.4;              // step length from which a small decrease means that the energy has settled
constexpr double kLongStep = 0.2, kMuchLess = 0.9;  // of perturbations that are gone on with, and of the error
constexpr double kHeldUp = 1e-3;                    // step length below which residual steps have come to an end
constexpr int kMostHeldUpSteps = 4;                 // steps in a row that are none, each damped more
constexpr int kIdleSteps = 8;                       // that together lower the energy by less than one has to
/// A step below this part of the image's size that lowers nothing is rounding: the energy is flat there.
constexpr double kRoundingOfSteps = 1e-6;

/// The step that is to be taken next where the scheme is automatic. While faces are flipped: residual steps, and when
/// these have come to an end perturbations. Then, towards a coefficient, perturbations as long as they are long and
/// gain much: from afar they come nearer than the barrier's steps. The barrier last.
class Scheme {
  public:
    Scheme(FlowScheme wanted, bool approach) : wanted_(wanted), approach_(approach) {}
    FlowScheme now(int flips) const {
        if (wanted_ != FlowScheme::automatic) return wanted_;
        if (flips > 0) return unturned_ ? FlowScheme::residual : FlowScheme::perturbation;
        return approach_ ? FlowScheme::perturbation : FlowScheme::barrier;
    }
    /// Told of every step.
    void taken(double length, int flips, double before, double after) {
        if (flips == 0 && (length < kLongStep || after > kMuchLess * before)) approach_ = false;
    }
    /// Whether another kind of step is left after those taken have come to an end.
    bool turns(int flips) {
        if (wanted_ != FlowScheme::automatic) return false;
        bool& left = flips > 0 ? unturned_ : approach_;
        return std::exchange(left, false);
    }

  private:
    FlowScheme wanted_;
    bool approach_, unturned_ = true;
};

void require_start(const Surface& source, const TargetConstraints& constraints, const TargetMap& start) {
    validate(constraints, source);
    if (start.points.size() != static_cast<std::size_t>(source.mesh.vertex_count()) ||
        start.parameters.size() != constraints.sliding.size())
        throw Error(Cause::bad_option, "the start belongs to another source or to other constraints");
}

/// The flow from a start, whatever it makes small.
class Flow {
  public:
    /// @param approach whether the coefficient that is wanted is one by which perturbations may come nearer
    Flow(const Surface& source, const Target& target, const TargetConstraints& constraints, TargetMap start,
         const SurfaceFlowOptions& options, bool approach)
        : source_(source),
          options_(options),
          motion_(source, target, constraints),
          scheme_(options.scheme, approach),
          step_(source.operators, motion_),
          vertex_weights_(weights_of(source.operators)) {
        result_.map = std::move(start);
        flips_ = flipped_samples(source.operators, result_.map);
        const Positions points = positions_of(result_.map.points);
        size_ = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    }

    /// @param energy of a scheme that is not automatic
    /// @param mu     #S wanted coefficient
    template <class EnergyOf>
    SurfaceFlowMap run(const Eigen::VectorXcd& mu, EnergyOf&& energy_of) {
        result_.termination = Termination::iteration_limit;
        std::unique_ptr<TargetEnergy> energy;
        FlowScheme of_energy = FlowScheme::automatic;
        while (result_.iterations < options_.max_iterations) {
            const FlowScheme scheme = scheme_.now(flips_);
            if (scheme == FlowScheme::barrier && flips_ > 0)
                throw Error(Cause::bad_option, "a barrier against flips needs a start without them; " +
                                                   std::to_string(flips_) + " samples are flipped");
            if (scheme != of_energy) energy = energy_of(of_energy = scheme);
            const TargetStep::Taken taken = take(*energy, scheme, mu);
            const End end = end_after(*energy, taken);
            if (end == End::none) {
                if (scheme == FlowScheme::perturbation && flips_ > 0 && taken.length < kHeldUp) opens_patches();
                continue;
            }
            if (scheme_.now(flips_) != scheme || opens_patches() || scheme_.turns(flips_)) continue;
            result_.termination =
                end == End::settled && flips_ == 0 ? Termination::converged : Termination::unconfirmed;
            break;
        }
        if (result_.termination == Termination::iteration_limit) opens_patches();
        return finish(mu);
    }

  private:
    static Eigen::VectorXd weights_of(const Operators& operators) {
        Eigen::VectorXd weights = Eigen::VectorXd::Zero(operators.vertex_count);
        for (int s = 0; s < operators.sample_count(); ++s)
            for (const int v : operators.stencil(s)) weights[v] += operators.weights[s];
        return weights;
    }

    TargetStep::Taken take(TargetEnergy& energy, FlowScheme scheme, const Eigen::VectorXcd& mu) {
        const TargetStep::Taken taken = step_.step(energy, result_.map, kLongestFlowMotion * size_);
        ++result_.iterations;
        if (motion_.unheld() && taken.length > 0) centre();
        flips_ = flipped_samples(source_.operators, result_.map);
        held_up_ = taken.length > 0 ? 0 : held_up_ + 1;
        if (energy.descends())
            fallen_.push_back(taken.fallen);
        else
            fallen_.clear();
        SurfaceFlowIteration now{
            scheme, taken.energy, taken.length, taken.movement / size_, coefficient_error(source_, result_.map, mu),
            0,      flips_};
        now.squared_error = now.error.l2 * now.error.l2 * source_.operators.area();
        const double before =
            result_.history.empty() ? std::numeric_limits<double>::infinity() : result_.history.back().squared_error;
        if (scheme == FlowScheme::perturbation) scheme_.taken(taken.length, flips_, before, now.squared_error);
        result_.history.push_back(now);
        if (options_.progress && !options_.progress(result_.iterations, now, result_.map))
            throw Error(Cause::cancelled, "cancelled after step " + std::to_string(result_.iterations));
        return taken;
    }

    /// Where steps leave flips that patches of means or unfolded ones do not: goes on with fewer.
    bool opens_patches() {
        const bool may = options_.scheme == FlowScheme::automatic || options_.scheme == FlowScheme::perturbation;
        if (!may || flips_ == 0) return false;
        std::vector<char> held;
        for (const signed char unknowns : motion_.unknowns()) held.push_back(unknowns < 2);
        int left = average_flipped_patches(source_, motion_.target(), held, result_.map);
        if (left == flips_) left = unfold_flipped_patches(source_, motion_.target(), held, result_.map);
        return std::exchange(flips_, left) > left;
    }

    /// How steps have come to an end.
    enum class End { none, settled, idle, held_up };

    End end_after(const TargetEnergy& energy, const TargetStep::Taken& taken) const {
        if (taken.length == 0) {
            if (taken.wanted < kRoundingOfSteps * size_) return End::settled;
            return energy.descends() && flips_ == 0 && held_up_ < kMostHeldUpSteps ? End::none : End::held_up;
        }
        if (flips_ > 0 && energy.descends() && taken.length < kHeldUp) return End::held_up;
        const bool whole = taken.length >= kWhole && !taken.damped;
        if (taken.movement < options_.tolerance * size_) return whole ? End::settled : End::idle;
        if (idle()) return End::idle;
        if (!whole) return End::none;
        return (energy.descends() && taken.fallen < options_.least_decrease) || error_settled() ? End::settled
                                                                                                : End::none;
    }

    /// Whether the last steps, which were cut short or damped, have together done no more than one has to.
    bool idle() const {
        return flips_ == 0 && std::ssize(fallen_) >= kIdleSteps &&
               std::accumulate(fallen_.end() - kIdleSteps, fallen_.end(), 0.0) < options_.least_decrease;
    }

    /// Steps go on along conformal maps where nothing is held, and lower energies that those change: then it is the
    /// error of the centred map that settles.
    bool error_settled() const {
        const std::vector<SurfaceFlowIteration>& history = result_.history;
        if (!motion_.unheld() || flips_ > 0 || history.size() < 2) return false;
        const double now = history.back().squared_error, before = history[history.size() - 2].squared_error;
        return std::abs(now - before) < options_.least_decrease * before;
    }

    /// To the representative that is centred, unless that would flip something.
    void centre() {
        TargetMap centred{motion_.target().centred(result_.map.points, vertex_weights_), {}};
        if (flipped_samples(source_.operators, centred) <= flipped_samples(source_.operators, result_.map))
            result_.map = std::move(centred);
    }

    SurfaceFlowMap finish(const Eigen::VectorXcd& mu) {
        result_.factorizations = step_.factorization_count();
        result_.distortion = distortion(
            source_.operators,
            derivatives(source_.operators, positions_of(result_.map.points), normals_of(result_.map.points)));
        result_.error = coefficient_error(source_, result_.map, mu);
        result_.fits = coefficient_fits(result_.error);
        if (!result_.distortion.flipped.empty())
            result_.warnings.push_back(
                {WarningKind::flipped_faces,
                 "flipped faces in the result: " + std::to_string(result_.distortion.flipped.size()) +
                     "; it is not one-to-one there",
                 {Things::faces, result_.distortion.flipped}});
        if (result_.termination == Termination::iteration_limit)
            result_.warnings.push_back(
                {WarningKind::iteration_limit,
                 "stopped after " + std::to_string(result_.iterations) + " steps before the map settled"});
        if (result_.termination == Termination::unconfirmed && result_.distortion.flipped.empty())
            result_.warnings.push_back(
                {WarningKind::iteration_limit,
                 "the last steps were cut short and came to nothing: the map may not be settled"});
        return std::move(result_);
    }

    const Surface& source_;
    const SurfaceFlowOptions& options_;
    TargetMotion motion_;
    Scheme scheme_;
    TargetStep step_;
    Eigen::VectorXd vertex_weights_;
    SurfaceFlowMap result_;
    std::vector<double> fallen_;  ///< by which parts the steps since the last perturbation lowered their energies
    int flips_ = 0;
    int held_up_ = 0;  ///< steps in a row that were none
    double size_ = 1;
};

/// The square of the direction that a vertex' frame has in that of a sample beside it.
Complex turn_to(const ImageFrame& frame, const TangentFrame& vertex) {
    const Complex direction = frame.along(vertex.first);
    return direction * direction / std::max(std::norm(direction), 1e-300);
}

}  // namespace

const char* to_string(FlowScheme scheme) {
    switch (scheme) {
        case FlowScheme::automatic:
            return "automatic";
        case FlowScheme::residual:
            return "residual";
        case FlowScheme::perturbation:
            return "perturbation";
        case FlowScheme::barrier:
            return "barrier";
    }
    return "";
}

void SurfaceFlowOptions::validate() const {
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance must be positive");
    if (!(least_decrease >= 0 && least_decrease < 1))
        throw Error(Cause::bad_option, "the least decrease must be from 0 to less than 1");
    if (max_iterations < 1) throw Error(Cause::bad_option, "there must be at least one iteration");
}

CoefficientError coefficient_error(const Surface& source, const TargetMap& map, const Eigen::VectorXcd& mu) {
    const Operators& operators = source.operators;
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    std::vector<TangentFrame> at_vertices;
    at_vertices.reserve(map.points.size());
    for (const Target::Point& point : map.points) at_vertices.emplace_back(point.normal);
    std::vector<ImageFrame> frames(static_cast<std::size_t>(operators.sample_count()));
    parallel_for(0, operators.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s) frames[s] = image_frame(operators, s, points, normals);
    });
    CoefficientErrorSum sums;
    // (∂̄f − μ∂f)/conj(∂f) in the frames of the vertices, in which it can be averaged, by |∂f|² and area.
    Eigen::VectorXcd mean = Eigen::VectorXcd::Zero(operators.vertex_count);
    Eigen::VectorXd around = Eigen::VectorXd::Zero(operators.vertex_count);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const ImageFrame& frame = frames[s];
        const Complex left = frame.q - mu[s] * frame.p;
        const double w = operators.weights[s];
        sums.add(w, frame.p, frame.q, mu[s]);
        for (const int v : operators.stencil(s)) {
            mean[v] += w * left * frame.p * std::conj(turn_to(frame, at_vertices[v]));
            around[v] += w * std::norm(frame.p);
        }
    }
    for (Eigen::Index v = 0; v < mean.size(); ++v)
        if (around[v] > 0) mean[v] /= around[v];
    const double smooth = parallel_sum(operators.sample_count(), 0.0, [&](int first, int last) {
        double part = 0;
        for (int s = first; s < last; ++s) {
            const auto stencil = operators.stencil(s);
            Complex sum = 0;
            for (const int v : stencil) sum += mean[v] * turn_to(frames[s], at_vertices[v]);
            part +=
                operators.weights[s] * std::norm(frames[s].p) * std::norm(sum / static_cast<double>(stencil.size()));
        }
        return part;
    });
    return sums.error(smooth);
}

SurfaceFlowMap surface_flow(const Surface& source, const Target& target, const Eigen::VectorXcd& mu,
                            const TargetConstraints& constraints, TargetMap start, const SurfaceFlowOptions& options) {
    options.validate();
    require_coefficient(source, mu);
    require_start(source, constraints, start);
    Flow flow(source, target, constraints, std::move(start), options, true);
    SurfaceFlowMap result = flow.run(mu, [&](FlowScheme scheme) -> std::unique_ptr<TargetEnergy> {
        const std::vector<double>& areas = source.operators.weights;
        if (scheme == FlowScheme::residual) return std::make_unique<ResidualEnergy>(mu, areas);
        if (scheme == FlowScheme::perturbation) return std::make_unique<PerturbationEnergy>(mu, areas);
        return std::make_unique<BarrierEnergy>(mu, areas);
    });
    if (!result.fits) result.warnings.push_back(misfit_warning(result.error));
    return result;
}

SurfaceFlowMap least_lp_map(const Surface& source, const Target& target, const LpNorm& norm,
                            const TargetConstraints& constraints, TargetMap start, const SurfaceFlowOptions& options) {
    options.validate();
    require_start(source, constraints, start);
    if (!(norm.p >= 2 && std::isfinite(norm.p))) throw Error(Cause::bad_option, "p must be at least 2 and finite");
    const std::vector<double>& weights = norm.weights.empty() ? source.operators.weights : norm.weights;
    if (static_cast<int>(weights.size()) != source.operators.sample_count())
        throw Error(Cause::bad_option, "there are " + std::to_string(weights.size()) + " weights for " +
                                           std::to_string(source.operators.sample_count()) + " samples");
    if (std::any_of(weights.begin(), weights.end(), [](double w) { return !(w > 0); }))
        throw Error(Cause::bad_option, "weights must be positive");
    const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(source.operators.sample_count());
    Flow flow(source, target, constraints, std::move(start), options, false);
    SurfaceFlowMap result = flow.run(zero, [&](FlowScheme scheme) -> std::unique_ptr<TargetEnergy> {
        if (scheme == FlowScheme::residual) return std::make_unique<ResidualEnergy>(zero, weights);
        if (scheme == FlowScheme::perturbation) return std::make_unique<PerturbationEnergy>(zero, weights);
        return std::make_unique<BarrierEnergy>(zero, weights, norm.p);
    });
    result.fits = true;  // none was wanted
    return result;
}

}  // namespace beltrami
