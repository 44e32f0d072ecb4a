#include <beltrami/evening/dilatation_patches.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/solve/coupled_system.h>

namespace beltrami {

namespace {

constexpr double kPenalty = 2000;
/// A restart brings the penalty back in these stages.
constexpr double kStages[] = {30, 400, kPenalty};
/// Its linear solution: the weight of r is lowered to this part, that of the phase becomes w.
constexpr double kLinear = 0.01;
constexpr int kSteps = 8, kLinearSteps = 3;
/// Marquardt's factor: first, after a good step, after a bad one, at least.
constexpr double kDamping = 1e-3, kEase = 0.2, kTighten = 6, kLeastDamping = 1e-6;
constexpr int kTrials = 6;
/// A descent ends where a step takes less than this part of the energy.
constexpr double kSettled = 1e-4;
constexpr int kExpectedFactorizations = 1;

double gap(const SpreadSample& s, double k) {
    return std::abs(std::sqrt((s.q_re * s.q_re + s.q_im * s.q_im) / (s.p_re * s.p_re + s.p_im * s.p_im)) - k);
}

/// The samples around some vertices, with a numbering of their own, in which only those vertices are free.
class Patch {
  public:
    Patch(const Operators& source, const VertexSamples& around, const std::vector<int>& vertices,
          const DilatationSpread& spread, const Eigen::VectorXcd& f)
        : vertices_(vertices) {
        std::vector<int> samples;
        for (const int v : vertices)
            for (const auto& corner : around[v]) samples.push_back(corner.sample);
        std::sort(samples.begin(), samples.end());
        samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
        std::vector<int> all;
        for (const int s : samples)
            for (const int v : source.stencil(s)) all.push_back(v);
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        const auto index = [&](int v) {
            return static_cast<int>(std::lower_bound(all.begin(), all.end(), v) - all.begin());
        };
        operators_.vertex_count = static_cast<int>(all.size());
        for (const int s : samples) {
            for (int c = source.offsets[s]; c < source.offsets[s + 1]; ++c) {
                operators_.vertices.push_back(index(source.vertices[c]));
                operators_.gradients.push_back(source.gradients[c]);
            }
            operators_.offsets.push_back(static_cast<int>(operators_.vertices.size()));
            operators_.weights.push_back(source.weights[s]);
        }
        freedoms_.assign(all.size(), Freedom::fixed);
        for (const int v : vertices) {
            locals_.push_back(index(v));
            freedoms_[locals_.back()] = Freedom::free;
        }
        f_.resize(static_cast<Eigen::Index>(all.size()));
        for (std::size_t i = 0; i < all.size(); ++i) f_[static_cast<Eigen::Index>(i)] = f[all[i]];
        spread_.emplace(operators_);
        spread_->set_samples(spread, samples);
        system_.emplace(operators_, freedoms_, kExpectedFactorizations);
    }

    /// @return steps taken
    int repair(double outlier) {
        const Eigen::VectorXcd start = f_;
        const Score first = score();
        int steps = descend(kPenalty, kSteps);
        Score best = score();
        Eigen::VectorXcd best_map = f_;
        if (best.gap > outlier || best.flipped > 0) {
            const std::vector<SpreadSample> weighted = spread_->samples();
            for (SpreadSample& s : spread_->samples()) {
                s.anchor = s.weight;
                s.weight *= kLinear;
            }
            steps += descend(0, kLinearSteps);
            for (std::size_t i = 0; i < weighted.size(); ++i) {
                spread_->samples()[i].anchor = weighted[i].anchor;
                spread_->samples()[i].weight = weighted[i].weight;
            }
            for (const double penalty : kStages) steps += descend(penalty, kSteps);
            const Score again = score();
            if (again.better_than(best)) {
                best = again;
                best_map = f_;
            }
        }
        f_ = best.better_than(first) ? best_map : start;
        return steps;
    }

    void write(Eigen::VectorXcd& f) const {
        for (std::size_t i = 0; i < vertices_.size(); ++i) f[vertices_[i]] = f_[locals_[i]];
    }

  private:
    struct Score {
        int flipped = 0;
        double gap = 0;
        bool better_than(const Score& other) const {
            return flipped != other.flipped ? flipped < other.flipped : gap < other.gap;
        }
    };
    Score score() const {
        Score result;
        for (const SpreadSample& s : spread_->samples()) {
            result.gap = std::max(result.gap, gap(s, spread_->k()));
            result.flipped += s.p_re * s.p_re + s.p_im * s.p_im <= s.q_re * s.q_re + s.q_im * s.q_im;
        }
        return result;
    }

    int descend(double penalty, int most) {
        double damping = kDamping, energy = spread_->value(penalty).energy;
        int step = 0;
        while (step < most) {
            ++step;
            const double before = energy;
            for (int trial = 0; trial < kTrials; ++trial) {
                spread_->set_map(f_);
                system_->set_zero();
                for (int s = 0; s < operators_.sample_count(); ++s) {
                    const auto e = spread_->element(s, penalty, DilatationSpread::Derivative::exact);
                    system_->add(s, e.gradient.data(), e.hessian.data());
                }
                system_->scale_diagonal(1 + damping);
                Eigen::VectorXcd moved;
                try {
                    moved = f_ + system_->solve().direction;
                } catch (const Error& error) {
                    if (error.cause() != Cause::not_solved) throw;
                    damping *= kTighten;
                    continue;
                }
                spread_->set_map(moved);
                const double there = spread_->value(penalty).energy;
                if (there < energy) {
                    f_ = moved;
                    energy = there;
                    damping = std::max(damping * kEase, kLeastDamping);
                    break;
                }
                damping *= kTighten;
            }
            if (!(before - energy > kSettled * before)) break;
        }
        spread_->set_map(f_);
        return step;
    }

    const std::vector<int>& vertices_;
    std::vector<int> locals_;
    Operators operators_;
    std::vector<Freedom> freedoms_;
    Eigen::VectorXcd f_;
    std::optional<DilatationSpread> spread_;
    std::optional<CoupledSystem> system_;
};

}  // namespace

DilatationPatches::DilatationPatches(const Operators& operators, const VertexSamples& around,
                                     const std::vector<Freedom>& freedoms, Options options)
    : operators_(operators), around_(around), freedoms_(freedoms), options_(options) {}

std::vector<int> DilatationPatches::surroundings(const std::vector<int>& samples, int rings) const {
    std::vector<char> in(static_cast<std::size_t>(operators_.vertex_count), 0);
    std::vector<int> front;
    const auto take = [&](int sample) {
        for (const int v : operators_.stencil(sample))
            if (!in[v]) {
                in[v] = 1;
                front.push_back(v);
            }
    };
    for (const int s : samples) take(s);
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const std::size_t end = front.size();
        for (; begin < end; ++begin)
            for (const auto& corner : around_[front[begin]]) take(corner.sample);
    }
    std::erase_if(front, [&](int v) { return freedoms_[v] != Freedom::free; });
    std::sort(front.begin(), front.end());
    return front;
}

std::vector<std::vector<int>> DilatationPatches::find(const DilatationSpread& spread, int rings) const {
    std::vector<int> outliers;
    for (int s = 0; s < operators_.sample_count(); ++s)
        if (!(gap(spread.samples()[s], spread.k()) <= options_.outlier)) outliers.push_back(s);
    std::vector<std::vector<int>> patches;
    // Parts of a patch that is too large have fewer rings. They share no sample with other patches, like the whole.
    for (; rings > 0 && !outliers.empty(); --rings) {
        const std::vector<int> vertices = surroundings(outliers, rings);
        std::vector<int> index(static_cast<std::size_t>(operators_.vertex_count), -1);
        for (std::size_t i = 0; i < vertices.size(); ++i) index[vertices[i]] = static_cast<int>(i);
        DisjointSets sets(static_cast<int>(vertices.size()));
        for (std::size_t i = 0; i < vertices.size(); ++i)
            for (const auto& corner : around_[vertices[i]])
                for (const int u : operators_.stencil(corner.sample))
                    if (index[u] >= 0) sets.join(static_cast<int>(i), index[u]);
        std::vector<std::vector<int>> lists(vertices.size());  // beside the representatives
        for (std::size_t i = 0; i < vertices.size(); ++i) lists[sets.find(static_cast<int>(i))].push_back(vertices[i]);
        const auto fits = [&](const std::vector<int>& list) {
            return static_cast<int>(list.size()) <= options_.most_vertices;
        };
        std::erase_if(outliers, [&](int s) {
            for (const int v : operators_.stencil(s))
                if (index[v] >= 0) return fits(lists[sets.find(index[v])]);
            return true;  // nothing can be moved
        });
        for (std::vector<int>& list : lists)
            if (!list.empty() && fits(list)) patches.push_back(std::move(list));
    }
    return patches;
}

int DilatationPatches::run(DilatationSpread& spread, Eigen::VectorXcd& f, int rings) const {
    const std::vector<std::vector<int>> patches = find(spread, rings);
    // Two patches share no sample, so they do not see each other's vertices move.
    std::vector<int> steps(patches.size());
    const Eigen::VectorXcd before = f;
    parallel_for(
        0, static_cast<int>(patches.size()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                Patch patch(operators_, around_, patches[i], spread, before);
                steps[i] = patch.repair(options_.outlier);
                patch.write(f);
            }
        },
        1);
    int total = 0;
    for (const int count : steps) total += count;
    if (total > 0) spread.set_map(f);
    return total;
}

}  // namespace beltrami
