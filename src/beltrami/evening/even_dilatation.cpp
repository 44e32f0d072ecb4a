#include <beltrami/evening/even_dilatation.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/evening/dilatation_patches.h>
#include <beltrami/evening/dilatation_sweeps.h>
#include <beltrami/solve/coupled_system.h>

namespace beltrami {

namespace {

/// Sweeps, then perhaps new φ and k, then perhaps a Gauss-Newton step. φ and k settle with the second step; what they
/// would still gain does not repay the c-steps.
struct Stage {
    int sweeps;
    double outlier_penalty;
    bool update;
    double damping;  ///< of the step; 0: none
};
/// The damping falls as φ and k settle; the penalty on outliers rises. Sweeps even out what is short, Gauss-Newton
/// steps what is long: with two sweeps before the first two, three steps do as well as four with one each. Two steps
/// with six sweeps each leave a scan with a spread of |μ| of .00824 in place of .00822, smooth data with .0056 in place
/// of .0055.
constexpr Stage kOneStage[] = {{1, 200, false, 0.002}};
constexpr Stage kTwoStages[] = {{6, 30, true, 0.01}, {6, 200, false, 0.001}};
constexpr Stage kThreeStages[] = {{2, 30, false, 0.02}, {2, 100, true, 0.003}, {1, 200, false, 0.002}};
constexpr int kMostSteps = 3;

std::span<const Stage> stages_of(int steps) {
    if (steps == 1) return kOneStage;
    if (steps == 2) return kTwoStages;
    if (steps == kMostSteps) return kThreeStages;
    return {};
}

constexpr Stage kLastStage{3, 400, false, 0};
/// Samples whose derivatives are found before they are added up.
constexpr int kSamplesAtOnce = 1024;
/// A stage in which E moves by less than this part of it is followed by the last one.
constexpr double kSettledEvening = 0.02;
/// Rings around outliers, round by round.
constexpr int kRings[] = {3, 4, 5, 6};
constexpr int kExpectedEveningFactorizations = 3;
/// A Gauss-Newton step is halved at most so often.
constexpr int kHalvings = 5;

/// The state that the stages work on.
class Evening {
  public:
    Evening(const Surface& source, std::vector<Freedom> freedoms, const EvenDilatationOptions& options)
        : operators_(source.operators),
          freedoms_(std::move(freedoms)),
          prepared_(prepare(options.steps)),
          around_(operators_),
          spread_(operators_),
          sweeps_(operators_, around_, freedoms_),
          patches_(operators_, around_, freedoms_, {options.outlier, options.most_patch_vertices}) {}

    DilatationSpread& spread() { return spread_; }
    const DilatationSweeps& sweeps() const { return sweeps_; }
    const DilatationPatches& patches() const { return patches_; }
    int factorizations() const { return system_ ? system_->factorization_count() : 0; }

    /// Shortened until the energy falls and nothing folds; may stay where it is.
    void gauss_newton(Eigen::VectorXcd& f, double damping) {
        if (!system_) system_ = prepared_.get();
        system_->set_zero();
        const int samples = operators_.sample_count();
        elements_.resize(static_cast<std::size_t>(std::min(samples, kSamplesAtOnce)));
        for (int begin = 0; begin < samples; begin += kSamplesAtOnce) {
            const int end = std::min(samples, begin + kSamplesAtOnce);
            parallel_for(
                begin, end,
                [&](int first, int last) {
                    for (int s = first; s < last; ++s)
                        elements_[s - begin] = spread_.element(s, 0, DilatationSpread::Derivative::size_held, damping);
                },
                kSamplesAtOnce / 8);
            for (int s = begin; s < end; ++s)
                system_->add(s, elements_[s - begin].gradient.data(), elements_[s - begin].hessian.data());
        }
        Eigen::VectorXcd direction;
        try {
            direction = system_->solve().direction;
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved) throw;
            return;  // sweeps go on without it
        }
        const DilatationSpread::Value before = spread_.value(0);
        double length = 1;
        for (int halving = 0; halving <= kHalvings; ++halving, length *= 0.5) {
            const Eigen::VectorXcd trial = f + length * direction;
            spread_.set_map(trial);
            if (spread_.value(0).improves(before)) {
                f = trial;
                return;
            }
        }
        spread_.set_map(f);
    }

  private:
    /// The system is ordered and analysed beside the sweeps.
    std::future<std::unique_ptr<CoupledSystem>> prepare(int steps) const {
        const bool beside = steps > 0 && thread_count() > 1;
        return std::async(beside ? std::launch::async : std::launch::deferred, [this] {
            return std::make_unique<CoupledSystem>(operators_, freedoms_, kExpectedEveningFactorizations);
        });
    }

    const Operators& operators_;
    std::vector<Freedom> freedoms_;
    std::future<std::unique_ptr<CoupledSystem>> prepared_;
    VertexSamples around_;
    DilatationSpread spread_;
    DilatationSweeps sweeps_;
    DilatationPatches patches_;
    std::unique_ptr<CoupledSystem> system_;  // from the first step on
    std::vector<DilatationSpread::Element> elements_;
};

void check(const Surface& source, const std::vector<Freedom>& freedoms, const Eigen::VectorXcd& start, double k,
           const Eigen::VectorXcd& phi) {
    if (static_cast<int>(freedoms.size()) != source.operators.vertex_count ||
        start.size() != source.operators.vertex_count)
        throw Error(Cause::bad_option, "freedoms and start need one entry per vertex");
    if (phi.size() != source.operators.sample_count()) throw Error(Cause::bad_option, "phi needs one entry per sample");
    if (!(k >= 0 && k < 1)) throw Error(Cause::bad_option, "k must be at least 0 and below 1");
    if (!phi.allFinite()) throw Error(Cause::bad_option, "phi is not finite");
    if (!start.allFinite()) throw Error(Cause::bad_boundary, "the start map is not finite");
}

}  // namespace

void EvenDilatationOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(steps >= 0 && steps <= kMostSteps, "steps must be 0 to 3");
    demand(anchor >= 0 && std::isfinite(anchor), "anchor must not be negative");
    demand(outlier > 0, "outlier must be positive");
    demand(most_patch_vertices >= 0, "most_patch_vertices must not be negative");
}

EvenDilatation even_dilatation(const Surface& source, const std::vector<Freedom>& freedoms,
                               const Eigen::VectorXcd& start, double k, const Eigen::VectorXcd& phi,
                               const CoefficientUpdate& coefficient_update, const EvenDilatationOptions& options) {
    options.validate();
    check(source, freedoms, start, k, phi);
    EvenDilatation result{start, phi, k};
    std::vector<Freedom> held = freedoms;
    std::replace(held.begin(), held.end(), Freedom::sliding, Freedom::fixed);
    fix_similarity(source, start, held);

    Eigen::VectorXcd f = start;
    int stage = 0;
    if (std::find(held.begin(), held.end(), Freedom::free) == held.end()) return result;
    Evening evening(source, std::move(held), options);
    DilatationSpread& spread = evening.spread();
    spread.set_coefficient(k, phi, options.anchor);
    spread.set_map(f);
    const auto report = [&] {
        ++stage;
        if (options.progress && !options.progress(stage, spread.value(0).energy))
            throw Error(Cause::cancelled, "cancelled after stage " + std::to_string(stage));
    };
    const auto run = [&](const Stage& s) {
        double least = spread.value(0).energy, most = least;
        const auto watch = [&] {
            const double energy = spread.value(0).energy;
            least = std::min(least, energy);
            most = std::max(most, energy);
        };
        evening.sweeps().run(spread, f, s.sweeps, s.outlier_penalty);
        result.sweeps += s.sweeps;
        watch();
        if (s.update && coefficient_update && coefficient_update(f, result.phi, result.k)) {
            check(source, freedoms, f, result.k, result.phi);
            spread.set_coefficient(result.k, result.phi, options.anchor);
            watch();
        }
        if (s.damping > 0) evening.gauss_newton(f, s.damping);
        watch();
        report();
        return most <= (1 + kSettledEvening) * least;
    };
    for (const Stage& of_step : stages_of(options.steps))
        if (run(of_step)) break;
    run(kLastStage);
    for (const int rings : kRings) {
        const int steps = evening.patches().run(spread, f, rings);
        result.patch_steps += steps;
        if (steps == 0) break;
        report();
    }
    result.factorizations = evening.factorizations();

    // Measured for the same φ and k.
    const DilatationSpread::Value after = spread.value(0);
    spread.set_map(start);
    const DilatationSpread::Value before = spread.value(0);
    result.improved = after.improves(before);
    if (result.improved) result.map = f;
    result.start_energy = before.energy;
    result.start_flipped = before.flipped;
    result.energy = result.improved ? after.energy : before.energy;
    result.flipped = result.improved ? after.flipped : before.flipped;
    return result;
}

}  // namespace beltrami
