#include <beltrami/charts/circle_matching.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/linear/decomposition.h>

namespace beltrami {

namespace {

constexpr std::size_t kMostExhaustive = 8;  // holes
/// Of more holes: pairs of source holes, and pairs of target holes onto which each is moved.
constexpr std::size_t kAnchors = 3, kTries = 60;
constexpr int kMostRounds = 50;
constexpr double kEqual = 1e-9;  // relative to the size of the domains' quadratic forms
/// Weight of |β|² against the pairs', for maps that they leave open.
constexpr double kLeastMove = 1e-11;

using Form = Eigen::Matrix4d;

/// What a pair adds to the quadratic form in (Re α, Im α, Re β, Im β).
Form form_of(const PlacePair& pair) {
    const auto [z, w] = pair;
    const Complex i(0, 1);
    // αz + β − w(β̄z + ᾱ) by its four unknowns.
    const std::array<Complex, 4> part{z - w, i * (z + w), 1.0 - w * z, i * (1.0 + w * z)};
    const double inside = (1 - std::norm(z)) * (1 - std::norm(w));
    const double weight = inside > 1e-9 ? 1 / inside : 1;
    Form form;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) form(a, b) = weight * std::real(part[a] * std::conj(part[b]));
    return form;
}

struct Fit {
    DiskMoebius move;
    double cost = 0;
};

/// The least value of a form where |α|² − |β|² = 1.
Fit fit(const Form& form) {
    const double size = form.trace();
    if (!(size > 0)) return {};
    Form regular = form;
    regular.diagonal().array() += kLeastMove * size;
    const Form lower = regular.llt().matrixL();
    Form signs = Form::Identity();
    signs(2, 2) = signs(3, 3) = -1;
    const auto triangle = lower.triangularView<Eigen::Lower>();
    const Form half = triangle.solve(signs);
    const Form reduced = triangle.solve(half.transpose());
    // 1/λ of the pencil (form, signs): the largest belongs to the least positive λ.
    const SymmetricEigen eigen = symmetric_eigen(0.5 * (reduced + reduced.transpose()));
    Eigen::Vector4d x = lower.transpose().triangularView<Eigen::Upper>().solve(eigen.vectors.col(3));
    x /= std::sqrt(x.dot(signs * x));
    const Complex alpha(x[0], x[1]), beta(x[2], x[3]);
    return {{std::arg(alpha * alpha), -beta / alpha}, std::max(0.0, x.dot(form * x))};
}

/// The assignment of least total cost: rows to columns, by shortest augmenting paths with potentials.
std::vector<int> cheapest_assignment(const std::vector<std::vector<double>>& cost) {
    const int n = static_cast<int>(cost.size());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> row_potential(n + 1, 0), column_potential(n + 1, 0);
    std::vector<int> row_of(n + 1, 0), way(n + 1, 0);  // counted from 1; column 0 holds the row to be placed
    for (int row = 1; row <= n; ++row) {
        row_of[0] = row;
        int column = 0;
        std::vector<double> least(n + 1, infinity);
        std::vector<char> used(n + 1, 0);
        do {
            used[column] = 1;
            const int r = row_of[column];
            double step = infinity;
            int next = 0;
            for (int c = 1; c <= n; ++c) {
                if (used[c]) continue;
                const double reduced = cost[r - 1][c - 1] - row_potential[r] - column_potential[c];
                if (reduced < least[c]) {
                    least[c] = reduced;
                    way[c] = column;
                }
                if (least[c] < step) {
                    step = least[c];
                    next = c;
                }
            }
            for (int c = 0; c <= n; ++c) {
                if (used[c]) {
                    row_potential[row_of[c]] += step;
                    column_potential[c] -= step;
                } else {
                    least[c] -= step;
                }
            }
            column = next;
        } while (row_of[column] != 0);
        for (; column != 0; column = way[column]) row_of[column] = row_of[way[column]];
    }
    std::vector<int> partner(n);
    for (int c = 1; c <= n; ++c) partner[row_of[c] - 1] = c - 1;
    return partner;
}

class Matcher {
  public:
    Matcher(std::span<const RoundHole> source, std::span<const RoundHole> target, const CircleMatchingOptions& options)
        : fixed_partner_(source.size(), -1), fixed_for_(source.size(), -1) {
        for (const auto& [i, j] : options.pairs) {
            fixed_partner_[i] = j;
            fixed_for_[j] = i;
        }
        for (const RoundHole& hole : source) source_.push_back(hyperbolic_circle(hole));
        for (const RoundHole& hole : target) target_.push_back(hyperbolic_circle(hole));
        places_.setZero();
        for (const PlacePair& pair : options.places) places_ += form_of(pair);
        const std::size_t n = source.size();
        forms_.resize(n * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) forms_[i * n + j] = form_of({source_[i].centre, target_[j].centre});
        for (std::size_t i = 0; i < n; ++i)
            size_ += 1 / (1 - std::norm(source_[i].centre)) + 1 / (1 - std::norm(target_[i].centre));
    }

    int size() const { return static_cast<int>(source_.size()); }

    Fit fit_of(const std::vector<int>& partner) const {
        Form form = places_;
        for (std::size_t i = 0; i < partner.size(); ++i) form += forms_[i * source_.size() + partner[i]];
        return fit(form);
    }

    /// Σ sinh²((ρ − ρ′)/2) of the pairs so far.
    double radii_of(const std::vector<int>& partner) const {
        double sum = 0;
        for (std::size_t i = 0; i < partner.size(); ++i) sum += radius_gap(i, partner[i]);
        return sum;
    }

    /// Takes the pairs with their best move, if better than what is known.
    void offer(const std::vector<int>& partner) {
        const Fit found = fit_of(partner);
        const double radii = radii_of(partner);
        const std::array<double, 4> rank{(found.cost + radii) / size_, radii, std::abs(found.move.centre),
                                         std::abs(found.move.rotation)};
        if (!best_.partner.empty()) {
            std::size_t k = 0;
            while (k < 4 && std::abs(rank[k] - rank_[k]) <= kTies[k]) ++k;
            if (k == 4 || rank[k] > rank_[k]) return;
        }
        rank_ = rank;
        best_ = {partner, found.move, 0};
    }

    /// All correspondences, but for those whose first pairs cost more than the best: adding pairs costs more.
    void offer_all() {
        std::vector<int> partner;
        std::vector<char> taken(source_.size(), 0);
        offer_from(partner, taken);
    }

    std::vector<int> assignment(const DiskMoebius& move) const {
        std::vector<std::vector<double>> cost(source_.size(), std::vector<double>(target_.size()));
        for (std::size_t i = 0; i < source_.size(); ++i)
            for (std::size_t j = 0; j < target_.size(); ++j)
                cost[i][j] = may_pair(i, j)
                                 ? hyperbolic_gap(move(source_[i].centre), target_[j].centre) + radius_gap(i, j)
                                 : kForbidden;
        return cheapest_assignment(cost);
    }

    /// Moves that bring two source holes far from each other to two target holes as far from each other.
    std::vector<DiskMoebius> likely_moves() const {
        struct Two {
            double gap;
            int a, b;
        };
        const auto all = [](const std::vector<HyperbolicCircle>& holes, bool both_ways) {
            std::vector<Two> result;
            for (int a = 0; a < static_cast<int>(holes.size()); ++a)
                for (int b = both_ways ? 0 : a + 1; b < static_cast<int>(holes.size()); ++b)
                    if (a != b) result.push_back({hyperbolic_gap(holes[a].centre, holes[b].centre), a, b});
            return result;
        };
        std::vector<Two> from = all(source_, false), to = all(target_, true);
        std::stable_sort(from.begin(), from.end(), [](const Two& x, const Two& y) { return x.gap > y.gap; });
        std::vector<DiskMoebius> moves{{}};
        for (std::size_t f = 0; f < std::min(kAnchors, from.size()); ++f) {
            const Two& two = from[f];
            std::stable_sort(to.begin(), to.end(), [&](const Two& x, const Two& y) {
                return std::abs(std::log(x.gap / two.gap)) < std::abs(std::log(y.gap / two.gap));
            });
            for (std::size_t t = 0; t < std::min(kTries, to.size()); ++t)
                moves.push_back(
                    fit(places_ + forms_[two.a * source_.size() + to[t].a] + forms_[two.b * source_.size() + to[t].b])
                        .move);
        }
        return moves;
    }

    CircleMatching best() const {
        CircleMatching result = best_;
        double squares = 0;
        for (std::size_t i = 0; i < result.partner.size(); ++i)
            squares += std::pow(2 * std::asinh(std::sqrt(hyperbolic_gap(result.move(source_[i].centre),
                                                                        target_[result.partner[i]].centre))),
                                2);
        if (!source_.empty()) result.distance = std::sqrt(squares / static_cast<double>(source_.size()));
        return result;
    }

  private:
    /// Differences of costs, radii, centres and rotations that count as none.
    static constexpr std::array<double, 4> kTies{kEqual, kEqual, 1e-6, 1e-6};
    /// Above the sum of all gaps of holes that double precision tells from the circle.
    static constexpr double kForbidden = 1e30;

    bool may_pair(std::size_t i, std::size_t j) const {
        return fixed_partner_[i] < 0 ? fixed_for_[j] < 0 : fixed_partner_[i] == static_cast<int>(j);
    }

    double radius_gap(std::size_t i, std::size_t j) const {
        return std::pow(std::sinh(0.5 * (source_[i].radius - target_[j].radius)), 2);
    }

    void offer_from(std::vector<int>& partner, std::vector<char>& taken) {
        const std::size_t n = source_.size();
        if (partner.size() == n) {
            offer(partner);
            return;
        }
        if (!best_.partner.empty() && partner.size() > 1 &&
            (fit_of(partner).cost + radii_of(partner)) / size_ > rank_[0] + 2 * kEqual)
            return;
        for (std::size_t j = 0; j < n; ++j) {
            if (taken[j] || !may_pair(partner.size(), j)) continue;
            taken[j] = 1;
            partner.push_back(static_cast<int>(j));
            offer_from(partner, taken);
            partner.pop_back();
            taken[j] = 0;
        }
    }

    std::vector<HyperbolicCircle> source_, target_;
    std::vector<int> fixed_partner_, fixed_for_;  ///< of source and target holes, -1: none
    Form places_;
    std::vector<Form> forms_;  ///< of source hole i and target hole j at i·n + j
    double size_ = 1e-300;
    std::array<double, 4> rank_{};
    CircleMatching best_;
};

/// Indices by decreasing radius; equal ones in their order.
std::vector<int> largest_first(std::span<const RoundHole> holes) {
    std::vector<int> order(holes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return holes[a].radius > holes[b].radius; });
    return order;
}

}  // namespace

DiskMoebius best_move(std::span<const PlacePair> pairs) {
    Form form = Form::Zero();
    for (const PlacePair& pair : pairs) form += form_of(pair);
    return fit(form).move;
}

DiskMoebius best_rotation(std::span<const PlacePair> pairs) {
    Complex sum = 0;
    double squares = 0;
    for (const auto& [z, w] : pairs) {
        sum += std::conj(z) * w;
        squares += std::norm(z) + std::norm(w);
    }
    return {std::abs(sum) > 1e-14 * squares ? std::arg(sum) : 0, 0};
}

CircleMatching match_circle_domains(std::span<const RoundHole> source, std::span<const RoundHole> target,
                                    const CircleMatchingOptions& options) {
    const std::size_t n = source.size();
    if (n != target.size())
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(n) + " holes, the target " + std::to_string(target.size()),
                    "both domains need the same number of boundary loops");
    if (n == 0) return {{}, best_move(options.places), 0};
    Matcher matcher(source, target, options);
    if (options.by == MatchBy::size) {
        std::vector<int> from = largest_first(source), to = largest_first(target), partner(n);
        for (const auto& [i, j] : options.pairs) {
            partner[i] = j;
            std::erase(from, i);
            std::erase(to, j);
        }
        for (std::size_t i = 0; i < from.size(); ++i) partner[from[i]] = to[i];
        matcher.offer(partner);
        return matcher.best();
    }
    if (n <= kMostExhaustive) {
        matcher.offer_all();
        return matcher.best();
    }
    for (DiskMoebius move : matcher.likely_moves()) {
        std::vector<int> partner;
        for (int round = 0; round < kMostRounds; ++round) {
            std::vector<int> next = matcher.assignment(move);
            if (next == partner) break;
            partner = std::move(next);
            matcher.offer(partner);
            move = matcher.fit_of(partner).move;
        }
    }
    return matcher.best();
}

}  // namespace beltrami
