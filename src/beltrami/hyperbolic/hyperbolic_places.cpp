#include <beltrami/hyperbolic/hyperbolic_places.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/hyperbolic/halfedges.h>
#include <beltrami/hyperbolic/target_walk.h>
#include <beltrami/uniformize/edge_flips.h>

namespace beltrami {

namespace {

/// The quadrilateral i l j k of an edge i→j that has become l→k, as vectors of the light cone whose products are the
/// squares of the lengths: l = α i + β j + γ k, γ < 0.
struct LightCone {
    double alpha, beta, gamma;

    LightCone(const IntrinsicTriangulation& flipped, const EdgeFlip& flip) {
        const int h = flip.halfedge, g = flip.twin;
        const double unit = flip.log_length;
        const auto square = [&](int halfedge) { return std::exp(2 * (flipped.log_length(halfedge) - unit)); };
        const double ki = square(next_halfedge(h)), il = square(previous_halfedge(h)), lj = square(next_halfedge(g)),
                     jk = square(previous_halfedge(g));
        Eigen::Matrix3d products;
        products << 0, 1, ki, 1, 0, jk, ki, jk, 0;
        const Eigen::Vector3d combination = products.inverse() * Eigen::Vector3d(il, lj, square(h));
        alpha = combination[0];
        beta = combination[1];
        gamma = combination[2];
    }
};

/// Points in the triangulation before flips by Ptolemy's relation.
std::vector<IntrinsicPoint> before_ptolemy(IntrinsicTriangulation flipped, const std::vector<EdgeFlip>& flips,
                                           std::vector<IntrinsicPoint> points) {
    std::vector<std::vector<int>> inside(static_cast<std::size_t>(flipped.triangle_count()));
    for (std::size_t p = 0; p < points.size(); ++p) inside[points[p].triangle].push_back(static_cast<int>(p));
    for (auto last = flips.rbegin(); last != flips.rend(); ++last) {
        const int h = last->halfedge, g = last->twin;
        const std::vector<int> of_h = std::exchange(inside[h / 3], {}), of_g = std::exchange(inside[g / 3], {});
        if (!of_h.empty() || !of_g.empty()) {
            const LightCone l(flipped, *last);
            const auto weight = [&](int p, int halfedge) { return points[p].weights[halfedge % 3]; };
            const auto put = [&](int p, double of_i, double of_j, double of_k, double of_l) {
                const bool left = of_k + l.gamma * of_l >= 0;
                const int first = left ? h : g;
                std::array<double, 3> w{};
                if (left)
                    w = {of_i + l.alpha * of_l, of_j + l.beta * of_l, of_k + l.gamma * of_l};
                else  // j, i, l
                    w = {of_j - of_k * l.beta / l.gamma, of_i - of_k * l.alpha / l.gamma, of_l + of_k / l.gamma};
                points[p].triangle = first / 3;
                const double sum = w[0] + w[1] + w[2];
                for (int c = 0; c < 3; ++c) points[p].weights[(first % 3 + c) % 3] = std::max(0.0, w[c]) / sum;
                inside[first / 3].push_back(p);
            };
            for (const int p : of_h)
                put(p, weight(p, previous_halfedge(h)), 0, weight(p, next_halfedge(h)), weight(p, h));
            for (const int p : of_g)
                put(p, 0, weight(p, previous_halfedge(g)), weight(p, g), weight(p, next_halfedge(g)));
        }
        flipped.undo(*last);
    }
    return points;
}

}  // namespace

std::vector<MeshPoint> places_of(const HyperbolicSurface& target, const EquivariantMap& map) {
    const auto count = static_cast<int>(map.bases.size());
    const std::vector<int> first = detail::first_halfedges(target);
    std::vector<IntrinsicPoint> points(static_cast<std::size_t>(count));
    parallel_for(0, count, [&](int begin, int end) {
        for (int v = begin; v < end; ++v) {
            const detail::TargetWalk walk = detail::walk(target, first[map.bases[v]], map.frames[v]);
            if (walk.halfedge >= 0) points[v] = {walk.halfedge / 3, walk.weights};
        }
    });
    std::vector<int> lost;
    for (int v = 0; v < count; ++v) {
        if (points[v].triangle < 0) {
            lost.push_back(v);
            continue;
        }
        // In the circumcircle preserving projective map a corner weighs e^u times as much.
        const int h = 3 * points[v].triangle;
        double largest = target.log_scale[target.delaunay.tail(h)], sum = 0;
        for (int k = 1; k < 3; ++k) largest = std::max(largest, target.log_scale[target.delaunay.tail(h + k)]);
        for (int k = 0; k < 3; ++k)
            sum += points[v].weights[k] *= std::exp(target.log_scale[target.delaunay.tail(h + k)] - largest);
        for (double& weight : points[v].weights) weight /= sum;
    }
    if (!lost.empty()) {
        const std::string missing = std::to_string(lost.size());
        throw Error(Cause::not_solved, missing + " vertices are not found on the target",
                    "remesh the target: its triangles are too thin for double precision",
                    {Things::vertices, std::move(lost)});
    }
    points = before_ptolemy(target.delaunay, target.ptolemy, std::move(points));
    IntrinsicTriangulation unfolded = target.delaunay;
    for (auto flip = target.ptolemy.rbegin(); flip != target.ptolemy.rend(); ++flip) unfolded.undo(*flip);
    points = before_flips(std::move(unfolded), target.unfolded, std::move(points));
    std::vector<MeshPoint> places;
    places.reserve(points.size());
    for (IntrinsicPoint& point : points) {
        if (point.triangle >= target.own_triangles()) {  // of the mirror image, whose corners run the other way
            point.triangle -= target.own_triangles();
            std::swap(point.weights[1], point.weights[2]);
        }
        const auto v = target.metric.triangles[point.triangle];
        places.push_back({target.metric.faces[point.triangle], {v[0], v[1], v[2]}, point.weights});
    }
    return places;
}

}  // namespace beltrami
