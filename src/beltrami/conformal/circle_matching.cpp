#include <beltrami/conformal/circle_matching.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include <beltrami/mesh/error.h>

namespace beltrami {

namespace {

constexpr std::size_t kMostExhaustive = 8;  // holes
constexpr std::size_t kAnchors = 4;         // source holes whose rotations onto targets are tried
constexpr int kMostRounds = 50;
constexpr double kEqual = 1e-9;  // relative to the squares of all centres

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
    Matcher(std::span<const RoundHole> source, std::span<const RoundHole> target, bool rotate)
        : source_(source), target_(target), rotate_(rotate) {
        for (const RoundHole& hole : source) squares_ += std::norm(hole.centre);
        for (const RoundHole& hole : target) squares_ += std::norm(hole.centre);
    }

    double best_rotation(const std::vector<int>& partner) const {
        if (!rotate_) return 0;
        Complex sum = 0;
        for (std::size_t i = 0; i < partner.size(); ++i)
            sum += std::conj(source_[i].centre) * target_[partner[i]].centre;
        return std::abs(sum) > 1e-14 * squares_ ? std::arg(sum) : 0;
    }

    /// Takes the pairs with their best rotation, if better than what is known.
    void offer(const std::vector<int>& partner) {
        const double rotation = best_rotation(partner);
        double cost = 0, radii = 0;
        for (std::size_t i = 0; i < partner.size(); ++i) {
            cost += std::norm(std::polar(1.0, rotation) * source_[i].centre - target_[partner[i]].centre);
            radii += std::pow(source_[i].radius - target_[partner[i]].radius, 2);
        }
        const double same = kEqual * (squares_ + 1e-300);
        bool better = best_.partner.empty() || cost < cost_ - same;
        if (!better && cost <= cost_ + same)
            better = radii < radii_ - kEqual ||
                     (radii <= radii_ + kEqual && std::abs(rotation) < std::abs(best_.rotation) - kEqual);
        if (!better) return;
        cost_ = cost;
        radii_ = radii;
        best_ = {partner, rotation, std::sqrt(cost / static_cast<double>(std::max<std::size_t>(1, partner.size())))};
    }

    std::vector<int> assignment(double rotation) const {
        std::vector<std::vector<double>> cost(source_.size(), std::vector<double>(target_.size()));
        for (std::size_t i = 0; i < source_.size(); ++i)
            for (std::size_t j = 0; j < target_.size(); ++j)
                cost[i][j] = std::norm(std::polar(1.0, rotation) * source_[i].centre - target_[j].centre);
        return cheapest_assignment(cost);
    }

    const CircleMatching& best() const { return best_; }

  private:
    std::span<const RoundHole> source_, target_;
    bool rotate_;
    double squares_ = 0, cost_ = 0, radii_ = 0;
    CircleMatching best_;
};

/// Indices by decreasing value; equal ones in their order.
template <class Value>
std::vector<int> largest_first(std::span<const RoundHole> holes, const Value& value) {
    std::vector<int> order(holes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return value(holes[a]) > value(holes[b]); });
    return order;
}

}  // namespace

CircleMatching match_circle_domains(std::span<const RoundHole> source, std::span<const RoundHole> target,
                                    const CircleMatchingOptions& options) {
    const std::size_t n = source.size();
    if (n != target.size())
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(n) + " holes, the target " + std::to_string(target.size()),
                    "both domains need the same number of boundary loops");
    Matcher matcher(source, target, options.rotate);
    if (options.by == MatchBy::size) {
        const auto radius = [](const RoundHole& hole) { return hole.radius; };
        const std::vector<int> from = largest_first(source, radius), to = largest_first(target, radius);
        std::vector<int> partner(n);
        for (std::size_t i = 0; i < n; ++i) partner[from[i]] = to[i];
        matcher.offer(partner);
        return matcher.best();
    }
    if (n <= kMostExhaustive) {
        std::vector<int> partner(n);
        std::iota(partner.begin(), partner.end(), 0);
        do matcher.offer(partner);
        while (std::next_permutation(partner.begin(), partner.end()));
        return matcher.best();
    }
    std::vector<double> rotations{0};
    if (options.rotate) {
        const std::vector<int> anchors =
            largest_first(source, [](const RoundHole& hole) { return std::abs(hole.centre); });
        for (std::size_t a = 0; a < std::min(kAnchors, n); ++a)
            for (const RoundHole& hole : target)
                rotations.push_back(std::arg(hole.centre * std::conj(source[anchors[a]].centre)));
    }
    for (double rotation : rotations) {
        std::vector<int> partner;
        for (int round = 0; round < kMostRounds; ++round) {
            std::vector<int> next = matcher.assignment(rotation);
            if (next == partner) break;
            partner = std::move(next);
            matcher.offer(partner);
            rotation = matcher.best_rotation(partner);
        }
    }
    return matcher.best();
}

}  // namespace beltrami
