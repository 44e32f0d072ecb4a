#include <beltrami/differentials/zeros_and_poles.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/differentials/argument_principle.h>
#include <beltrami/differentials/table_zeros.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/quad_split.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// What is this near to the boundary, as part of the edge there, lies on it.
constexpr double kRim = 0.25;
/// Points that are evaluated at once.
constexpr int kPointsPerChunk = 1024;

/// A triangle of a face, in the order in which MeshPoint names its corners.
struct FaceTriangle {
    int face;
    std::array<int, 3> vertices;
};

/// The surface in the plane in which φ is a function: that of its own coordinates where φ is known there, else that of
/// the chart; with a rim along the boundary.
class PlaneOfDifferential {
  public:
    PlaneOfDifferential(const Surface& source, const QuadraticDifferential& phi) : source_(source), phi_(phi) {
        const Eigen::VectorXcd* own = phi.chart->exact && phi.chart->analytic ? source.coordinate() : nullptr;
        own_ = own != nullptr;
        const Eigen::VectorXcd& z = own ? *own : phi.chart->vertices;
        region_.points = z;
        add_faces(z);
        add_rim(z);
    }

    std::vector<CriticalPoint> search() const {
        const PlaneFunction f = [this](const Eigen::VectorXcd& points) { return values(points); };
        std::vector<CriticalPoint> result;
        for (const PlaneZero& zero : zeros_and_poles_in(region_, f, phi_.poles, phi_.jumps))
            result.push_back(place(zero));
        std::stable_sort(result.begin(), result.end(),
                         [](const CriticalPoint& a, const CriticalPoint& b) { return a.place.face < b.place.face; });
        return result;
    }

  private:
    struct BoundaryEdge {
        int from, to;
        Complex at_from, at_to;
    };

    Eigen::VectorXcd values(const Eigen::VectorXcd& points) const {
        Eigen::VectorXcd result(points.size());
        parallel_for(
            0, static_cast<int>(points.size()),
            [&](int first, int last) {
                ChartPoints at{points.segment(first, last - first), Eigen::VectorXcd::Ones(last - first)};
                for (Eigen::Index i = 0; i < at.positions.size() && own_; ++i) {
                    const auto [position, derivative] = phi_.chart->analytic(at.positions[i]);
                    at.positions[i] = position;
                    at.derivatives[i] = derivative;
                }
                result.segment(first, last - first) = phi_.at(at);
            },
            kPointsPerChunk);
        return result;
    }

    void add_faces(const Eigen::VectorXcd& z) {
        const Operators& operators = source_.operators;
        std::vector<char> seen(static_cast<std::size_t>(operators.face_count), 0);
        for (int s = 0; s < operators.sample_count(); ++s)
            if (!phi_.chart->excluded[s]) seen[operators.faces[s]] = 1;
        for (int f = 0; f < operators.face_count; ++f) {
            const auto v = source_.mesh.faces[f];
            std::vector<std::array<int, 3>> corners{{0, 1, 2}};
            if (v.size() == 4) {
                std::array<Eigen::Vector3d, 4> points;
                for (int j = 0; j < 4; ++j) points[j] = {z[v[j]].real(), z[v[j]].imag(), 0};
                const auto halves = split_quad(points);
                corners.assign(halves.begin(), halves.end());
            }
            for (const auto& [a, b, c] : corners) {
                const FaceTriangle triangle{f, {v[a], v[b], v[c]}};
                for (int j = 0; j < 3; ++j)
                    beside_.try_emplace({triangle.vertices[j], triangle.vertices[(j + 1) % 3]}, triangle);
                if (!seen[f] || !(cross(z[v[b]] - z[v[a]], z[v[c]] - z[v[a]]) > 0)) continue;
                region_.triangles.push_back(triangle.vertices);
                triangles_.push_back(triangle);
            }
        }
    }

    /// Two triangles outside every boundary edge.
    void add_rim(const Eigen::VectorXcd& z) {
        std::vector<Complex> points(z.begin(), z.end());
        for (const std::vector<int>& loop : source_.topology.boundary_loops) {
            const std::size_t n = loop.size();
            const auto first = static_cast<int>(points.size());
            for (std::size_t i = 0; i < n; ++i) {
                const Complex at = z[loop[i]], in = at - z[loop[(i + n - 1) % n]], out = z[loop[(i + 1) % n]] - at;
                boundary_.push_back({loop[i], loop[(i + 1) % n], at, at + out});
                // Faces are on the left.
                const Complex along = in / std::abs(in) + out / std::abs(out);
                const Complex outward = Complex(0, -1) * (std::abs(along) > 0 ? along / std::abs(along) : in);
                points.push_back(at + kRim * std::min(std::abs(in), std::abs(out)) * outward);
            }
            for (std::size_t i = 0; i < n; ++i) {
                const int a = loop[i], b = loop[(i + 1) % n], over_a = first + static_cast<int>(i),
                          over_b = first + static_cast<int>((i + 1) % n);
                for (const std::array<int, 3>& t : {std::array{a, over_a, over_b}, std::array{a, over_b, b}})
                    if (cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) > 0)
                        region_.triangles.push_back(t);
            }
        }
        region_.points = Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size()));
    }

    CriticalPoint place(const PlaneZero& zero) const {
        const bool outside = zero.triangle >= static_cast<int>(triangles_.size());
        double least = std::numeric_limits<double>::infinity(), along = 0;
        const BoundaryEdge* nearest = nullptr;
        for (const BoundaryEdge& edge : boundary_) {
            const Complex direction = edge.at_to - edge.at_from;
            const double t =
                std::clamp(std::real((zero.at - edge.at_from) * std::conj(direction)) / std::norm(direction), 0.0, 1.0);
            const double distance = std::abs(zero.at - edge.at_from - t * direction) / std::abs(direction);
            if (!(distance < least)) continue;
            least = distance;
            along = t;
            nearest = &edge;
        }
        if (nearest && (outside || least <= kRim)) {
            const FaceTriangle& beside = beside_.at({nearest->from, nearest->to});
            MeshPoint point{beside.face, beside.vertices, {0, 0, 0}};
            for (int j = 0; j < 3; ++j) {
                if (beside.vertices[j] == nearest->from) point.barycentric[j] = 1 - along;
                if (beside.vertices[j] == nearest->to) point.barycentric[j] = along;
            }
            return {point, zero.order, true};
        }
        const FaceTriangle& triangle = triangles_[zero.triangle];
        std::array<Complex, 3> corners;
        for (int j = 0; j < 3; ++j) corners[j] = region_.points[triangle.vertices[j]];
        auto weights = barycentric(corners, zero.at);
        weights[0] = std::clamp(weights[0], 0.0, 1.0);  // on an edge up to rounding
        weights[1] = std::clamp(weights[1], 0.0, 1.0 - weights[0]);
        weights[2] = 1 - weights[0] - weights[1];
        return {{triangle.face, triangle.vertices, weights}, zero.order, false};
    }

    const Surface& source_;
    const QuadraticDifferential& phi_;
    bool own_ = false;
    PlaneTriangles region_;
    std::vector<FaceTriangle> triangles_;                 ///< the first of the region's; those of the rim follow
    std::map<std::pair<int, int>, FaceTriangle> beside_;  ///< on the left of a directed edge
    std::vector<BoundaryEdge> boundary_;
};

}  // namespace

std::vector<CriticalPoint> zeros_and_poles(const Surface& source, const QuadraticDifferential& phi) {
    if (phi.zero()) return {};
    if (!phi.tabulated()) return PlaneOfDifferential(source, phi).search();
    const Eigen::VectorXcd values = phi.at_samples(source);
    if (values.size() != source.operators.sample_count())
        throw Error(Cause::bad_option, "φ has " + std::to_string(values.size()) + " values for " +
                                           std::to_string(source.operators.sample_count()) + " samples");
    return zeros_and_poles_of_table(source, values, phi.poles, !phi.space->complex_coefficients());
}

}  // namespace beltrami
