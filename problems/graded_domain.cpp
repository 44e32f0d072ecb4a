#include "problems/graded_domain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/constants.h>
#include <beltrami/meshing/delaunay.h>

#include "problems/construct.h"

namespace beltrami::bench {

namespace {

/// Edges at transitions, as part of h², and at pins, as part of h: what is pinned inside moves its faces, and the
/// smaller these are the farther. Elsewhere h (r/from)^kExponent, but no more than this part of r.
constexpr double kFinestTransition = 0.1, kFinestPin = 0.03, kExponent = 0.75, kSlope = 0.3;
constexpr double kPinsFrom = 0.25, kTransitionsFrom = 0.5;
constexpr double kHoleEdges = 40;
/// Arcs of the outer curve have at least so many edges, the whole of one without ends so many.
constexpr int kLeastEdges = 2, kLeastAround = 32;

/// The place of a curve nearest to p.
class NearestPlace {
  public:
    explicit NearestPlace(const OuterCurve& curve) : curve_(curve) {
        for (int i = 0; i < kSamples; ++i) samples_.push_back(curve.at(static_cast<double>(i) / kSamples));
    }
    Complex operator()(Complex p) const {
        const auto nearest = std::min_element(samples_.begin(), samples_.end(), [&](Complex a, Complex b) {
            return std::norm(a - p) < std::norm(b - p);
        });
        const auto i = static_cast<double>(nearest - samples_.begin());
        const auto distance = [&](double t) { return std::norm(curve_.at(t - std::floor(t)) - p); };
        // Golden section between the neighbours.
        double low = (i - 1) / kSamples, high = (i + 1) / kSamples;
        for (int step = 0; step < 60; ++step) {
            const double cut = (high - low) / std::numbers::phi;
            if (distance(high - cut) < distance(low + cut))
                high = low + cut;
            else
                low = high - cut;
        }
        const double t = 0.5 * (low + high);
        return curve_.at(t - std::floor(t));
    }

  private:
    static constexpr int kSamples = 512;
    const OuterCurve& curve_;
    std::vector<Complex> samples_;
};

SizeField size_of(double h, const GradedPlaces& fine) {
    return [h, fine](const Eigen::Vector2d& p) {
        const Complex z(p.x(), p.y());
        double wanted = h;
        const auto finer_at = [&](Complex place, double finest, double from) {
            const double far = std::abs(z - place);
            wanted = std::min(wanted, finest + std::min(kSlope * far, h * std::pow(far / from, kExponent)));
        };
        for (const Complex pin : fine.pins) finer_at(pin, kFinestPin * h, kPinsFrom);
        for (const Complex place : fine.transitions) finer_at(place, kFinestTransition * h * h, kTransitionsFrom);
        for (const RoundHoleOf& hole : fine.holes) {
            const double away = std::max(0.0, std::abs(z - hole.centre) - hole.radius);
            wanted = std::min(wanted, std::min(fine.hole_edge * h, kTurn * hole.radius / kHoleEdges) + kSlope * away);
        }
        return wanted;
    };
}

}  // namespace

OuterCurve unit_circle(std::vector<double> angles) {
    std::sort(angles.begin(), angles.end());
    if (angles.empty()) angles = {0};
    for (double& angle : angles) angle /= kTurn;
    return {[](double t) { return std::polar(1.0, kTurn * t); }, angles};
}

Mesh graded_mesh(double edge_length, const OuterCurve& outer, const GradedPlaces& fine) {
    const SizeField size = size_of(edge_length, fine);
    PlanarDomain domain;
    for (const Complex z : fine.pins) domain.points.push_back(point(z));
    const auto add_curve = [&](int curve, const std::function<Complex(double)>& at, const std::vector<double>& ends) {
        const int first = static_cast<int>(domain.points.size());
        for (std::size_t a = 0; a < ends.size(); ++a) {
            const double from = ends[a], to = a + 1 < ends.size() ? ends[a + 1] : ends[0] + 1;
            const auto place = [&](double s) {
                const double t = from + s * (to - from);
                return at(t > 1 ? t - 1 : t);
            };
            const auto pieces = [&](double s) {
                constexpr double kStep = 1e-6;
                const double near = std::clamp(s, kStep, 1 - kStep);
                const double speed = std::abs(place(near + kStep) - place(near - kStep)) / (2 * kStep);
                return size(point(place(s))) / speed;
            };
            const std::vector<double> s = spread(1, pieces, ends.size() > 1 ? kLeastEdges : kLeastAround);
            for (std::size_t k = 0; k + 1 < s.size(); ++k) domain.points.push_back(point(place(s[k])));
        }
        const int n = static_cast<int>(domain.points.size()) - first;
        for (int k = 0; k < n; ++k) {
            domain.segments.push_back({first + k, first + (k + 1) % n});
            domain.curves.push_back(curve);
        }
    };
    add_curve(0, outer.at, outer.ends);
    for (std::size_t i = 0; i < fine.holes.size(); ++i)
        add_curve(static_cast<int>(i) + 1,
                  [&](double t) { return fine.holes[i].centre + std::polar(fine.holes[i].radius, kTurn * t); }, {0});
    const NearestPlace nearest(outer);
    domain.project = [&](int curve, const Eigen::Vector2d& p) {
        const Complex z(p.x(), p.y());
        if (curve == 0) return point(nearest(z));
        const RoundHoleOf& hole = fine.holes[curve - 1];
        return point(hole.centre + hole.radius * (z - hole.centre) / std::abs(z - hole.centre));
    };
    TriangulateOptions options;
    options.size = size;
    return triangulate(domain, options);
}

}  // namespace beltrami::bench
