#include <beltrami/certificate/chart_quadrilateral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <beltrami/base/constants.h>
#include <beltrami/certificate/modulus.h>

namespace beltrami {

namespace {

/// Least edges of a side, and the part of the rim where that has few.
constexpr int kSide = 8, kSidesOfRim = 8;
/// Vertices of which all quadrilaterals are looked at, and how many of the best are moved from there.
constexpr int kPlaces = 20, kStarts = 4;
/// Images are on a circle within this part of its radius.
constexpr double kOnCircle = 1e-6;

/// Four vertices, by their positions on the rim.
using Corners = std::array<int, 4>;

class Search {
  public:
    Search(const std::vector<double>& from, const std::vector<double>& to)
        : from_(from), to_(to), n_(static_cast<int>(from.size())), side_(std::min(kSide, n_ / kSidesOfRim)) {}

    double best() const {
        if (side_ < 1) return 1;
        struct Start {
            double value;
            Corners corners;
        };
        std::vector<Start> starts;
        const std::vector<int> places = spread();
        const int count = static_cast<int>(places.size());
        for (int a = 0; a < count; ++a)
            for (int b = a + 1; b < count; ++b)
                for (int c = b + 1; c < count; ++c)
                    for (int d = c + 1; d < count; ++d) {
                        const Corners corners{places[a], places[b], places[c], places[d]};
                        if (!allowed(corners)) continue;
                        const double found = value(corners);
                        if (static_cast<int>(starts.size()) == kStarts && found <= starts.back().value) continue;
                        starts.push_back({found, corners});
                        std::sort(starts.begin(), starts.end(),
                                  [](const Start& x, const Start& y) { return x.value > y.value; });
                        if (static_cast<int>(starts.size()) > kStarts) starts.pop_back();
                    }
        double largest = 0;
        for (const Start& start : starts) largest = std::max(largest, improved(start.value, start.corners));
        return std::exp(largest);
    }

  private:
    /// Vertices spread evenly by what they turn here and there.
    std::vector<int> spread() const {
        std::vector<int> places;
        const double first = from_[0] + to_[0];
        for (int i = 0, next = 0; i < n_ && next < kPlaces; ++i)
            if (from_[i] + to_[i] - first >= 2 * kTurn * next / kPlaces) {
                places.push_back(i);
                ++next;
            }
        return places;
    }
    bool allowed(const Corners& corners) const {
        for (int i = 0; i < 4; ++i) {
            const int edges = corners[(i + 1) % 4] - corners[i] + (i == 3 ? n_ : 0);
            if (edges < side_) return false;
        }
        return true;
    }
    double value(const Corners& corners) const {
        std::array<double, 4> here, there;
        for (int i = 0; i < 4; ++i) {
            here[i] = from_[corners[i]];
            there[i] = to_[corners[i]];
        }
        return std::abs(std::log(disk_modulus(there) / disk_modulus(here)));
    }
    /// Corners moved along the rim as long as that helps, by ever smaller steps.
    double improved(double least, Corners corners) const {
        for (int step = std::max(1, n_ / kPlaces); step > 0;) {
            bool moved = false;
            for (int i = 0; i < 4; ++i)
                for (const int by : {step, -step}) {
                    Corners next = corners;
                    next[i] += by;
                    if (next[i] < 0 || next[i] >= n_ || !std::is_sorted(next.begin(), next.end()) || !allowed(next))
                        continue;
                    const double found = value(next);
                    if (!(found > least)) continue;
                    least = found;
                    corners = next;
                    moved = true;
                }
            if (!moved) step /= 2;
        }
        return least;
    }

    const std::vector<double>&from_, &to_;
    int n_, side_;
};

/// Angles about a centre, ascending, from the first in (−π, π]; none if they do not run around once, forward.
std::optional<std::vector<double>> ascending_angles(const std::vector<Complex>& points, Complex centre) {
    std::vector<double> angles{std::arg(points[0] - centre)};
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step = std::arg((points[i] - centre) / (points[i - 1] - centre));
        if (!(step > 0)) return std::nullopt;
        angles.push_back(angles.back() + step);
    }
    if (!(angles.back() - angles.front() < kTurn)) return std::nullopt;
    return angles;
}

/// The centre of the circle through three points.
Complex circumcentre(Complex a, Complex b, Complex c) {
    const Complex u = b - a, v = c - a;
    const double twice = 2 * std::imag(std::conj(u) * v);
    return a + Complex(0, 1) * (std::norm(u) * v - std::norm(v) * u) / -twice;
}

}  // namespace

double quadrilateral_ratio(const std::vector<double>& from, const std::vector<double>& to) {
    return Search(from, to).best();
}

double chart_quadrilateral_estimate(const Surface& source, const Chart& chart, const std::vector<Complex>& images) {
    const std::size_t n = images.size();
    const auto& loops = source.topology.boundary_loops;
    if (n < kSidesOfRim || loops.size() != 1 || loops[0].size() != n) return 1;
    const Complex centre = circumcentre(images[0], images[n / 3], images[2 * n / 3]);
    const double radius = std::abs(images[0] - centre);
    for (const Complex image : images)
        if (!(std::abs(std::abs(image - centre) - radius) <= kOnCircle * radius)) return 1;
    std::vector<Complex> rim;
    for (const int v : loops[0]) rim.push_back(chart.vertices[v]);
    const auto from = ascending_angles(rim, 0), to = ascending_angles(images, centre);
    return from && to ? quadrilateral_ratio(*from, *to) : 1;
}

}  // namespace beltrami
