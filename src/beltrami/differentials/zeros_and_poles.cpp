#include <beltrami/differentials/zeros_and_poles.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
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
constexpr double kRimOfZeros = 0.25;
/// What is this near to each other, as part of an edge, is one.
constexpr double kSamePoint = 0.02;
/// Points that are evaluated at once.
constexpr int kPointsPerZeroChunk = 1024;

/// A triangle of a face, in the order in which MeshPoint names its corners.
struct FaceTriangle {
    int face;
    std::array<int, 3> vertices;
    std::array<int, 3> points;  ///< of the plane: of an atlas other ones than the vertices
};

/// Of every corner, the number of its point in the plane, and these points: a vertex has two where parts of an atlas
/// meet.
struct CornerPoints {
    std::vector<int> of_corners;  ///< #corners
    std::vector<int> vertices;    ///< #points
    Eigen::VectorXcd points;
};

CornerPoints corner_points(const FaceList& faces, const Eigen::VectorXcd& corners) {
    CornerPoints result;
    std::map<std::tuple<int, double, double>, int> numbers;
    std::vector<Complex> points;
    for (int c = 0; c < faces.corner_count(); ++c) {
        const int v = faces.vertices()[c];
        const auto [at, is_new] =
            numbers.try_emplace({v, corners[c].real(), corners[c].imag()}, static_cast<int>(points.size()));
        if (is_new) {
            points.push_back(corners[c]);
            result.vertices.push_back(v);
        }
        result.of_corners.push_back(at->second);
    }
    result.points = Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size()));
    return result;
}

/// The surface in the plane in which φ is a function: that of its own coordinates where φ is known there, else that of
/// the chart; with a rim along the boundary. The parts of an atlas lie side by side.
class PlaneOfDifferential {
  public:
    PlaneOfDifferential(const Surface& source, const QuadraticDifferential& phi) : source_(source), phi_(phi) {
        if (phi.chart->corners.size() > 0) {
            const CornerPoints atlas = corner_points(source.mesh.faces, phi.chart->corners);
            region_.points = atlas.points;
            for (int p = 0; p < static_cast<int>(atlas.vertices.size()); ++p) {
                const int v = atlas.vertices[p];
                if (std::binary_search(phi.poles.begin(), phi.poles.end(), v)) poles_.push_back(p);
                if (std::binary_search(phi.jumps.begin(), phi.jumps.end(), v)) jumps_.push_back(p);
            }
            add_faces(atlas.of_corners);
            return;
        }
        const Eigen::VectorXcd* own = phi.chart->exact && phi.chart->analytic ? source.coordinate() : nullptr;
        own_ = own != nullptr;
        region_.points = own ? *own : phi.chart->vertices;
        poles_ = phi.poles;
        jumps_ = phi.jumps;
        add_faces(source.mesh.faces.vertices());
        add_rim(Eigen::VectorXcd(region_.points));
    }

    std::vector<CriticalPoint> search() const {
        const PlaneFunction f = [this](const Eigen::VectorXcd& points) { return values(points); };
        std::vector<CriticalPoint> result;
        for (const PlaneZero& zero : zeros_and_poles_in(region_, f, poles_, jumps_)) result.push_back(place(zero));
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
            kPointsPerZeroChunk);
        return result;
    }

    /// @param points of every corner the number of its point
    void add_faces(const std::vector<int>& points) {
        const Eigen::VectorXcd& z = region_.points;
        const Operators& operators = source_.operators;
        std::vector<char> seen(static_cast<std::size_t>(operators.face_count), 0);
        for (int s = 0; s < operators.sample_count(); ++s)
            if (!phi_.chart->excluded[s]) seen[operators.faces[s]] = 1;
        for (int f = 0; f < operators.face_count; ++f) {
            const auto v = source_.mesh.faces[f];
            const int* p = points.data() + source_.mesh.faces.first_corner(f);
            std::vector<std::array<int, 3>> corners{{0, 1, 2}};
            if (v.size() == 4) {
                std::array<Eigen::Vector3d, 4> quad;
                for (int j = 0; j < 4; ++j) quad[j] = {z[p[j]].real(), z[p[j]].imag(), 0};
                const auto halves = split_quad(quad);
                corners.assign(halves.begin(), halves.end());
            }
            for (const auto& [a, b, c] : corners) {
                const FaceTriangle triangle{f, {v[a], v[b], v[c]}, {p[a], p[b], p[c]}};
                for (int j = 0; j < 3; ++j)
                    beside_.try_emplace({triangle.vertices[j], triangle.vertices[(j + 1) % 3]}, triangle);
                if (!seen[f] || !(cross(z[p[b]] - z[p[a]], z[p[c]] - z[p[a]]) > 0)) continue;
                region_.triangles.push_back(triangle.points);
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
                points.push_back(at + kRimOfZeros * std::min(std::abs(in), std::abs(out)) * outward);
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
        if (nearest && (outside || least <= kRimOfZeros)) {
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
        for (int j = 0; j < 3; ++j) corners[j] = region_.points[triangle.points[j]];
        auto weights = barycentric(corners, zero.at);
        weights[0] = std::clamp(weights[0], 0.0, 1.0);  // on an edge up to rounding
        weights[1] = std::clamp(weights[1], 0.0, 1.0 - weights[0]);
        weights[2] = 1 - weights[0] - weights[1];
        return {{triangle.face, triangle.vertices, weights}, zero.order, false};
    }

    const Surface& source_;
    const QuadraticDifferential& phi_;
    bool own_ = false;
    std::vector<int> poles_, jumps_;  ///< points of the region
    PlaneTriangles region_;
    std::vector<FaceTriangle> triangles_;                 ///< the first of the region's; those of the rim follow
    std::map<std::pair<int, int>, FaceTriangle> beside_;  ///< on the left of a directed edge
    std::vector<BoundaryEdge> boundary_;
};

/// Of an atlas, what was found from both sides of an edge along which its parts meet once only.
void drop_repeated(const Surface& source, std::vector<CriticalPoint>& points) {
    const auto at = [&](const CriticalPoint& point) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int j = 0; j < 3; ++j) sum += point.place.barycentric[j] * source.mesh.point(point.place.vertices[j]);
        return sum;
    };
    const auto edge = [&](const CriticalPoint& point) {
        double least = std::numeric_limits<double>::infinity();
        for (int j = 0; j < 3; ++j)
            least = std::min(least, (source.mesh.point(point.place.vertices[j]) -
                                     source.mesh.point(point.place.vertices[(j + 1) % 3]))
                                        .norm());
        return least;
    };
    std::vector<CriticalPoint> kept;
    for (const CriticalPoint& point : points)
        if (std::none_of(kept.begin(), kept.end(), [&](const CriticalPoint& other) {
                return other.order == point.order && (at(other) - at(point)).norm() <= kSamePoint * edge(point);
            }))
            kept.push_back(point);
    points = std::move(kept);
}

/// The orders on a closed surface: −2χ.
bool all_found(const Surface& source, const std::vector<CriticalPoint>& points) {
    int sum = 0;
    for (const CriticalPoint& point : points) sum += point.order;
    return sum == 4 * source.topology.genus - 4;
}

}  // namespace

std::vector<CriticalPoint> zeros_and_poles(const Surface& source, const QuadraticDifferential& phi) {
    if (phi.zero()) return {};
    if (!phi.tabulated()) {
        std::vector<CriticalPoint> points = PlaneOfDifferential(source, phi).search();
        if (phi.chart->corners.size() == 0) return points;
        drop_repeated(source, points);
        if (all_found(source, points)) return points;
        // What fell between the straight edges along which the parts meet is told by the values on the faces.
        return zeros_and_poles_of_table(source, phi.at_samples(source), phi.poles, false);
    }
    const Eigen::VectorXcd values = phi.at_samples(source);
    if (values.size() != source.operators.sample_count())
        throw Error(Cause::bad_option, "φ has " + std::to_string(values.size()) + " values for " +
                                           std::to_string(source.operators.sample_count()) + " samples");
    return zeros_and_poles_of_table(source, values, phi.poles, !phi.space->complex_coefficients());
}

}  // namespace beltrami
