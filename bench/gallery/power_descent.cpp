#include "gallery/power_descent.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace beltrami::gallery {

namespace {

using Function = std::function<double(const Eigen::VectorXd&, Eigen::VectorXd&)>;

struct Minimum {
    Eigen::VectorXd x;
    double value = 0;
    int iterations = 0;
};

/// L-BFGS with 20 pairs and a line search that halves and doubles until the Wolfe conditions hold; an infinite value
/// bars the way.
Minimum minimise(const Function& f, Eigen::VectorXd x, int max_iterations, double tolerance) {
    constexpr std::size_t memory = 20;
    std::deque<std::pair<Eigen::VectorXd, Eigen::VectorXd>> pairs;
    Eigen::VectorXd gradient(x.size()), next_gradient(x.size());
    Minimum best{x, f(x, gradient), 0};
    while (best.iterations < max_iterations) {
        Eigen::VectorXd direction = -gradient;
        std::vector<double> alphas;
        for (auto pair = pairs.rbegin(); pair != pairs.rend(); ++pair) {
            alphas.push_back(pair->first.dot(direction) / pair->first.dot(pair->second));
            direction -= alphas.back() * pair->second;
        }
        if (!pairs.empty())
            direction *= pairs.back().first.dot(pairs.back().second) / pairs.back().second.squaredNorm();
        for (const auto& [step, change] : pairs) {
            const double beta = change.dot(direction) / step.dot(change);
            direction += (alphas.back() - beta) * step;
            alphas.pop_back();
        }
        double slope = gradient.dot(direction);
        if (slope >= 0) {
            pairs.clear();
            direction = -gradient;
            slope = -gradient.squaredNorm();
        }
        double low = 0, high = std::numeric_limits<double>::infinity(), t = pairs.empty() ? 1e-3 / direction.norm() : 1,
               value = best.value;
        bool found = false;
        for (int i = 0; i < 40; ++i) {
            value = f(x + t * direction, next_gradient);
            if (!(value <= best.value + 1e-4 * t * slope))
                high = t;
            else if (next_gradient.dot(direction) < 0.9 * slope)
                low = t;
            else {
                found = true;
                break;
            }
            t = std::isfinite(high) ? 0.5 * (low + high) : 2 * t;
        }
        if (!found && !(value < best.value)) break;
        const Eigen::VectorXd step = t * direction, change = next_gradient - gradient;
        if (step.dot(change) > 1e-14 * step.norm() * change.norm()) {
            pairs.emplace_back(step, change);
            if (pairs.size() > memory) pairs.pop_front();
        }
        const double gained = best.value - value;
        x += step;
        gradient = next_gradient;
        best = {x, value, best.iterations + 1};
        if (gained < tolerance * std::abs(value)) break;
    }
    return best;
}

/// Maps as vectors: coordinates of the vertices that are free, then arc lengths of those that slide along curves.
class Unknowns {
  public:
    Unknowns(const Surface& surface, const std::vector<int>& fixed, Eigen::VectorXcd start)
        : surface_(surface), map_(std::move(start)) {
        std::vector<char> held(map_.size(), 0);
        for (const int v : fixed) held[v] = 1;
        for (int v = 0; v < map_.size(); ++v)
            if (!held[v]) free_.push_back(v);
    }
    /// @pre the vertex is one of the fixed ones
    void slide(int vertex, const TargetCurve& curve, double parameter) {
        sliding_.push_back({vertex, &curve, parameter});
    }

    Eigen::Index size() const {
        return 2 * static_cast<Eigen::Index>(free_.size()) + static_cast<Eigen::Index>(sliding_.size());
    }
    Eigen::VectorXd coordinates() const {
        Eigen::VectorXd x(size());
        for (std::size_t i = 0; i < free_.size(); ++i)
            x.segment<2>(2 * i) << map_[free_[i]].real(), map_[free_[i]].imag();
        for (std::size_t i = 0; i < sliding_.size(); ++i) x[2 * free_.size() + i] = sliding_[i].parameter;
        return x;
    }
    const Eigen::VectorXcd& map(const Eigen::VectorXd& x) {
        for (std::size_t i = 0; i < free_.size(); ++i) map_[free_[i]] = {x[2 * i], x[2 * i + 1]};
        for (std::size_t i = 0; i < sliding_.size(); ++i)
            map_[sliding_[i].vertex] = sliding_[i].curve->point(x[2 * free_.size() + i]);
        return map_;
    }

    struct Term {
        double value;
        Complex by_dz, by_dzbar;  ///< slopes: the value grows by Re(conj(by_dz) δ∂f + conj(by_dzbar) δ∂̄f)
    };
    /// Σ of terms of (∂f, ∂̄f) over the samples and its gradient.
    double sum(const Eigen::VectorXd& x, const std::function<Term(int sample, Complex dz, Complex dzbar)>& term,
               Eigen::Ref<Eigen::VectorXd> gradient) {
        const Eigen::VectorXcd& f = map(x);
        const Operators& operators = surface_.operators;
        Eigen::VectorXcd slopes = Eigen::VectorXcd::Zero(f.size());
        double value = 0;
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto [dz, dzbar] = operators.derivatives(s, f);
            const Term now = term(s, dz, dzbar);
            value += now.value;
            // ∂f = ½ Σ f conj(g), ∂̄f = ½ Σ f g.
            const auto stencil = operators.stencil(s);
            const auto hats = operators.gradient(s);
            for (std::size_t j = 0; j < stencil.size(); ++j)
                slopes[stencil[j]] += 0.5 * (now.by_dz * hats[j] + now.by_dzbar * std::conj(hats[j]));
        }
        for (std::size_t i = 0; i < free_.size(); ++i)
            gradient.segment<2>(2 * i) << slopes[free_[i]].real(), slopes[free_[i]].imag();
        for (std::size_t i = 0; i < sliding_.size(); ++i)
            gradient[2 * free_.size() + i] =
                std::real(std::conj(slopes[sliding_[i].vertex]) * sliding_[i].curve->tangent(x[2 * free_.size() + i]));
        return value;
    }

  private:
    struct Sliding {
        int vertex;
        const TargetCurve* curve;
        double parameter;
    };
    const Surface& surface_;
    Eigen::VectorXcd map_;
    std::vector<int> free_;
    std::vector<Sliding> sliding_;
};

/// h(|μ|²), |μ|² = |∂̄f|²/|∂f|²; @p slope is h′.
Unknowns::Term of_square(double value, double slope, Complex dz, Complex dzbar) {
    return {value, -2 * slope * std::norm(dzbar) / (std::norm(dz) * std::norm(dz)) * dz,
            2 * slope / std::norm(dz) * dzbar};
}

}  // namespace

Descent least_power(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& start, double p,
                    int max_iterations) {
    Unknowns unknowns(surface, boundary.vertices, start);
    const double area = surface.operators.area();
    const auto energy = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
        return unknowns.sum(
            x,
            [&](int s, Complex dz, Complex dzbar) {
                const double w = surface.operators.weights[s] / area, square = std::norm(dzbar) / std::norm(dz),
                             lower = std::pow(square, 0.5 * p - 1);
                return of_square(w * lower * square, w * 0.5 * p * lower, dz, dzbar);
            },
            gradient);
    };
    const Minimum least = minimise(energy, unknowns.coordinates(), max_iterations, 1e-9);
    return {unknowns.map(least.x), least.iterations, least.value};
}

Descent least_largest(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& start,
                      int max_iterations) {
    Unknowns unknowns(surface, boundary.vertices, start);
    const Eigen::Index n = unknowns.size();
    Eigen::VectorXd x(n + 1);
    x << unknowns.coordinates(), 1.05 * distortion(surface.operators, start).max;
    const double samples = surface.operators.sample_count();
    int iterations = 0;
    for (double epsilon = 0.3 * x[n]; epsilon > 1e-4 && iterations < max_iterations; epsilon *= 0.4) {
        const auto energy = [&](const Eigen::VectorXd& y, Eigen::VectorXd& gradient) {
            const double t = y[n];
            double by_t = 1;
            const double barrier = unknowns.sum(
                y.head(n),
                [&](int, Complex dz, Complex dzbar) -> Unknowns::Term {
                    const double room = t * t - std::norm(dzbar) / std::norm(dz);
                    if (!(room > 0) || !(t > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
                    by_t -= epsilon / samples * 2 * t / room;
                    return of_square(-epsilon / samples * std::log(room), epsilon / samples / room, dz, dzbar);
                },
                gradient.head(n));
            gradient[n] = by_t;
            return t + barrier;
        };
        const Minimum stage = minimise(energy, x, std::min(400, max_iterations - iterations), 1e-8);
        x = stage.x;
        iterations += stage.iterations;
    }
    return {unknowns.map(x.head(n)), iterations, x[n]};
}

Descent nearest_coefficient(const Surface& source, const TargetDomain& target, const SlidMap& start,
                            const Eigen::VectorXcd& nu, double p, int max_iterations) {
    std::vector<int> boundary;
    for (const auto& loop : source.topology.boundary_loops) boundary.insert(boundary.end(), loop.begin(), loop.end());
    Unknowns unknowns(source, boundary, start.map);
    for (const LoopOnto& onto : start.loops) {
        const std::vector<int>& loop = source.topology.boundary_loops[onto.loop];
        for (std::size_t i = 0; i < loop.size(); ++i)
            unknowns.slide(loop[i], target.curve(onto.curve), onto.parameters[i]);
    }
    const double area = source.operators.area();
    const auto energy = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
        return unknowns.sum(
            x,
            [&](int s, Complex dz, Complex dzbar) -> Unknowns::Term {
                const double w = source.operators.weights[s] / area;
                const Complex off = dzbar / dz - nu[s], slope = w * p * std::pow(std::abs(off), p - 2) * off;
                return {w * std::pow(std::abs(off), p), -slope * std::conj(dzbar / (dz * dz)), slope / std::conj(dz)};
            },
            gradient);
    };
    const Minimum least = minimise(energy, unknowns.coordinates(), max_iterations, 1e-10);
    return {unknowns.map(least.x), least.iterations, std::pow(least.value, 1 / p)};
}

}  // namespace beltrami::gallery
