#include <beltrami/differentials/argument_principle.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/base/disjoint_sets.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Along a piece over which a function changes by less than this part of its size its argument turns no further than
/// the ends show.
constexpr double kQuiet = 0.5;
/// A path is divided so often at most: a zero nearer than this power of ½ of an edge lies on it.
constexpr int kMostDivisions = 14;
/// Radius of circles about zeros and poles, as part of the shortest edge there, and the pieces it is begun with.
constexpr double kCircle = 0.02;
constexpr int kCirclePieces = 16;
/// Newton's method: steps, its step of differences and the step at which it ends as parts of the size of what is
/// searched, and the part of the circle's radius at which it is near enough for the circle to tell.
constexpr int kNewtonSteps = 60;
constexpr double kDifference = 1e-5, kSettled = 1e-13, kNear = 0.1;
/// How often starts are taken anew, with the zeros divided out that are known.
constexpr int kRounds = 4;
/// Barycentric coordinates inside a triangle are not below this.
constexpr double kInside = -1e-6;
/// A sum of turns is a whole number up to this.
constexpr double kWhole = 1e-3;

/// A part of a path, with the values at its ends.
struct Piece {
    int path;
    double from, to;
    Complex at_from, at_to;
};

bool has_argument(Complex value) {
    return std::isfinite(std::norm(value)) && value != 0.0;
}

/// What the argument turns along each path, in radians, where it can be followed.
/// @param point place on a path, from path and parameter
template <class Point>
std::vector<std::optional<double>> turning(const PlaneFunction& f, std::vector<Piece> pieces, int paths,
                                           const Point& point) {
    std::vector<std::optional<double>> turned(static_cast<std::size_t>(paths), 0.0);
    for (int division = 0; !pieces.empty(); ++division) {
        std::vector<Piece> loud;
        for (const Piece& piece : pieces) {
            std::optional<double>& sum = turned[piece.path];
            if (!sum) continue;
            const Complex a = piece.at_from, b = piece.at_to;
            const bool known = has_argument(a) && has_argument(b);
            if (known && std::abs(b - a) <= kQuiet * std::min(std::abs(a), std::abs(b)))
                *sum += std::arg(b / a);
            else if (known && division < kMostDivisions)
                loud.push_back(piece);
            else
                sum.reset();
        }
        std::erase_if(loud, [&](const Piece& piece) { return !turned[piece.path]; });
        Eigen::VectorXcd middles(static_cast<Eigen::Index>(loud.size()));
        for (std::size_t i = 0; i < loud.size(); ++i)
            middles[static_cast<Eigen::Index>(i)] = point(loud[i].path, 0.5 * (loud[i].from + loud[i].to));
        const Eigen::VectorXcd values = loud.empty() ? Eigen::VectorXcd() : f(middles);
        pieces.clear();
        for (std::size_t i = 0; i < loud.size(); ++i) {
            const Piece& whole = loud[i];
            const double middle = 0.5 * (whole.from + whole.to);
            const Complex value = values[static_cast<Eigen::Index>(i)];
            pieces.push_back({whole.path, whole.from, middle, whole.at_from, value});
            pieces.push_back({whole.path, middle, whole.to, value, whole.at_to});
        }
    }
    return turned;
}

std::optional<int> whole_turns(double radians) {
    const double turns = radians / kTurn, whole = std::round(turns);
    if (std::abs(turns - whole) > kWhole) return {};
    return static_cast<int>(whole);
}

/// Triangles between which the argument cannot be followed, or one around which it turns.
struct Cluster {
    std::vector<int> triangles;  ///< ascending
    std::optional<int> turns;    ///< around all of them
};

class Search {
  public:
    Search(const PlaneTriangles& region, const PlaneFunction& f, const std::vector<int>& poles,
           const std::vector<int>& cuts)
        : region_(region), f_(f), poles_(poles) {
        values_ = f(region.points);
        for (const auto* singular : {&poles, &cuts})
            for (const int p : *singular) values_[p] = std::numeric_limits<double>::quiet_NaN();
        follow_edges();
    }

    std::vector<PlaneZero> run() const {
        std::vector<PlaneZero> result;
        for (const Cluster& cluster : clusters())
            for (const PlaneZero& zero : zeros_of(cluster)) result.push_back(zero);
        std::stable_sort(result.begin(), result.end(),
                         [](const PlaneZero& a, const PlaneZero& b) { return a.triangle < b.triangle; });
        return result;
    }

  private:
    Complex corner(int triangle, int j) const { return region_.points[region_.triangles[triangle][j]]; }

    void follow_edges() {
        const auto& triangles = region_.triangles;
        std::map<std::pair<int, int>, int> numbers;
        std::vector<std::array<int, 2>> ends;
        edges_.resize(triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int j = 0; j < 3; ++j) {
                const auto [a, b] = std::minmax(triangles[t][j], triangles[t][(j + 1) % 3]);
                const auto [at, fresh] = numbers.try_emplace({a, b}, static_cast<int>(ends.size()));
                if (fresh) ends.push_back({a, b});
                edges_[t][j] = at->second;
            }
        std::vector<Piece> pieces;
        for (std::size_t e = 0; e < ends.size(); ++e)
            pieces.push_back({static_cast<int>(e), 0, 1, values_[ends[e][0]], values_[ends[e][1]]});
        turned_ = turning(f_, std::move(pieces), static_cast<int>(ends.size()), [&](int edge, double t) {
            return (1 - t) * region_.points[ends[edge][0]] + t * region_.points[ends[edge][1]];
        });
    }

    /// Along an edge of a triangle, in its direction.
    std::optional<double> turned(int triangle, int j) const {
        const std::optional<double>& turn = turned_[edges_[triangle][j]];
        const auto& corners = region_.triangles[triangle];
        return turn && corners[j] > corners[(j + 1) % 3] ? -*turn : turn;
    }

    std::vector<Cluster> clusters() const {
        const int count = static_cast<int>(region_.triangles.size());
        DisjointSets sets(count);
        std::vector<int> first_beside(turned_.size(), -1);  // of edges that cannot be followed
        std::vector<char> lost(static_cast<std::size_t>(count), 0);
        for (int t = 0; t < count; ++t)
            for (const int e : edges_[t]) {
                if (turned_[e]) continue;
                lost[t] = 1;
                if (first_beside[e] < 0)
                    first_beside[e] = t;
                else
                    sets.join(first_beside[e], t);
            }
        std::map<int, Cluster> found;
        for (int t = 0; t < count; ++t) {
            if (lost[t]) {
                found[sets.find(t)].triangles.push_back(t);
                continue;
            }
            double sum = 0;
            for (int j = 0; j < 3; ++j) sum += *turned(t, j);
            if (const std::optional<int> turns = whole_turns(sum); turns && *turns != 0) found[t] = {{t}, turns};
        }
        std::vector<Cluster> result;
        for (auto& [first, cluster] : found) {
            if (lost[first]) cluster.turns = turns_around(cluster.triangles);
            result.push_back(std::move(cluster));
        }
        return result;
    }

    std::optional<int> turns_around(const std::vector<int>& triangles) const {
        std::map<int, int> uses;
        for (const int t : triangles)
            for (const int e : edges_[t]) ++uses[e];
        double sum = 0;
        for (const int t : triangles)
            for (int j = 0; j < 3; ++j) {
                if (uses[edges_[t][j]] > 1) continue;
                const std::optional<double> turn = turned(t, j);
                if (!turn) return {};
                sum += *turn;
            }
        return whole_turns(sum);
    }

    /// The triangle of some in which a point lies, up to rounding; −1 if there is none.
    int triangle_at(const std::vector<int>& triangles, Complex point) const {
        int best = -1;
        double most = kInside;
        for (const int t : triangles) {
            const auto weights = barycentric({corner(t, 0), corner(t, 1), corner(t, 2)}, point);
            const double least = *std::min_element(weights.begin(), weights.end());
            if (least > most) {
                most = least;
                best = t;
            }
        }
        return best;
    }

    std::vector<PlaneZero> zeros_of(const Cluster& cluster) const {
        Complex middle = 0;
        double shortest = std::numeric_limits<double>::infinity(), size = 0;
        for (const int t : cluster.triangles) middle += corner(t, 0) / static_cast<double>(cluster.triangles.size());
        for (const int t : cluster.triangles)
            for (int j = 0; j < 3; ++j) {
                shortest = std::min(shortest, std::abs(corner(t, (j + 1) % 3) - corner(t, j)));
                size = std::max(size, std::abs(corner(t, j) - middle));
            }
        const double radius = kCircle * shortest;
        std::vector<PlaneZero> found;
        int sum = 0;
        const auto try_at = [&](Complex at, bool pole) {
            for (const PlaneZero& known : found)
                if (std::abs(known.at - at) < radius) return;
            const int triangle = triangle_at(cluster.triangles, at);
            if (triangle < 0) return;
            const std::optional<int> turns = turns_on_circle(f_, at, radius);
            if (!turns || *turns == 0 || (!pole && *turns < 0)) return;
            found.push_back({at, *turns, triangle});
            sum += *turns;
        };
        for (const int p : poles_of(cluster)) try_at(region_.points[p], true);
        for (int round = 0; round < kRounds && !(cluster.turns && sum == *cluster.turns); ++round)
            for (const Complex at : newton(starts(cluster, round), found, middle, size, radius)) try_at(at, false);
        return found;
    }

    std::vector<int> poles_of(const Cluster& cluster) const {
        std::vector<int> result;
        for (const int t : cluster.triangles)
            for (const int p : region_.triangles[t])
                if (std::binary_search(poles_.begin(), poles_.end(), p)) result.push_back(p);
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    /// Middles of the triangles, and from the second round on places near their corners.
    std::vector<Complex> starts(const Cluster& cluster, int round) const {
        std::vector<Complex> result;
        for (const int t : cluster.triangles) {
            const Complex middle = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
            result.push_back(middle);
            for (int j = 0; j < 3 && round > 0; ++j)
                result.push_back(middle + (1 - std::pow(0.5, round)) * (corner(t, j) - middle));
        }
        return result;
    }

    /// Where Newton's method for f/∏(z − known)^order ends, as far as it does.
    std::vector<Complex> newton(std::vector<Complex> at, const std::vector<PlaneZero>& known, Complex middle,
                                double size, double radius) const {
        const double h = kDifference * size;
        std::vector<double> moved(at.size(), std::numeric_limits<double>::infinity());
        std::vector<std::size_t> running(at.size());
        for (std::size_t i = 0; i < at.size(); ++i) running[i] = i;
        for (int step = 0; step < kNewtonSteps && !running.empty(); ++step) {
            Eigen::VectorXcd points(3 * static_cast<Eigen::Index>(running.size()));
            for (std::size_t n = 0; n < running.size(); ++n)
                points.segment<3>(3 * static_cast<Eigen::Index>(n)) << at[running[n]], at[running[n]] + h,
                    at[running[n]] - h;
            const Eigen::VectorXcd values = f_(points);
            std::vector<std::size_t> left;
            for (std::size_t n = 0; n < running.size(); ++n) {
                const std::size_t i = running[n];
                const auto v = values.segment<3>(3 * static_cast<Eigen::Index>(n));
                Complex logarithmic = (v[1] - v[2]) / (2 * h);  // times f
                for (const PlaneZero& zero : known)
                    logarithmic -= v[0] * static_cast<double>(zero.order) / (at[i] - zero.at);
                const Complex change = v[0] == 0.0 ? 0.0 : -v[0] / logarithmic;
                moved[i] = std::abs(change);
                at[i] += change;
                if (!std::isfinite(moved[i]) || std::abs(at[i] - middle) > 2 * size)
                    moved[i] = std::numeric_limits<double>::infinity();
                else if (moved[i] > kSettled * size)
                    left.push_back(i);
            }
            running = std::move(left);
        }
        std::vector<Complex> ends;
        for (std::size_t i = 0; i < at.size(); ++i)
            if (moved[i] < kNear * radius) ends.push_back(at[i]);
        return ends;
    }

    const PlaneTriangles& region_;
    const PlaneFunction& f_;
    const std::vector<int>& poles_;
    Eigen::VectorXcd values_;                    ///< at the points
    std::vector<std::array<int, 3>> edges_;      ///< of every triangle, from corner j to the next
    std::vector<std::optional<double>> turned_;  ///< along every edge, from its smaller point
};

}  // namespace

std::array<double, 3> barycentric(const std::array<Complex, 3>& triangle, Complex point) {
    const auto& [a, b, c] = triangle;
    const double area = cross(b - a, c - a), u = cross(b - point, c - point) / area,
                 v = cross(c - point, a - point) / area;
    return {u, v, 1 - u - v};
}

std::optional<int> turns_on_circle(const PlaneFunction& f, Complex centre, double radius) {
    const auto point = [&](int, double t) { return centre + std::polar(radius, kTurn * t); };
    Eigen::VectorXcd points(kCirclePieces);
    for (int i = 0; i < kCirclePieces; ++i) points[i] = point(0, static_cast<double>(i) / kCirclePieces);
    const Eigen::VectorXcd values = f(points);
    std::vector<Piece> pieces;
    pieces.reserve(kCirclePieces);
    for (int i = 0; i < kCirclePieces; ++i)
        pieces.push_back({0, static_cast<double>(i) / kCirclePieces, (i + 1.0) / kCirclePieces, values[i],
                          values[(i + 1) % kCirclePieces]});
    const std::optional<double> turned = turning(f, std::move(pieces), 1, point)[0];
    return turned ? whole_turns(*turned) : std::nullopt;
}

std::vector<PlaneZero> zeros_and_poles_in(const PlaneTriangles& region, const PlaneFunction& f,
                                          const std::vector<int>& poles, const std::vector<int>& cuts) {
    return Search(region, f, poles, cuts).run();
}

}  // namespace beltrami
