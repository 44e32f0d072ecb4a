#include <beltrami/registration/ways_to_cut.h>

#include <algorithm>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/locate/point_at.h>

namespace beltrami {

namespace {

constexpr std::size_t kMostPermuted = 5;   // open curves of which all orders are looked at
constexpr std::size_t kMostMeasured = 12;  // orders whose geodesics are found
constexpr std::size_t kMostWays = 6;

/// A curve that is passed in its direction or against it.
struct Passed {
    std::size_t curve;
    bool reversed;
};
using Order = std::vector<Passed>;

MeshWithCurves of_surface(const char* name, const Mesh& mesh, std::span<const CurveThrough> curves) {
    try {
        return mesh_with_curves(mesh, curves);
    } catch (const Error& error) {
        throw Error(error.cause(), std::string("the ") + name + ": " + error.what(), {}, error.where());
    }
}

/// Open curves one after the other as one, joined from end to beginning, and the closed ones.
std::vector<CurveThrough> joined(std::span<const CurveThrough> curves, const Order& order) {
    std::vector<CurveThrough> result{{}};
    for (const auto& [curve, reversed] : order) {
        std::vector<MeshPoint> points = curves[curve].points;
        if (reversed) std::reverse(points.begin(), points.end());
        result[0].points.insert(result[0].points.end(), points.begin(), points.end());
    }
    for (const CurveThrough& curve : curves)
        if (curve.closed) result.push_back(curve);
    return result;
}

void reverse(MeshWithCurves::Chain& chain) {
    std::reverse(chain.vertices.begin(), chain.vertices.end());
    std::reverse(chain.lengths.begin(), chain.lengths.end());
    std::reverse(chain.given.begin(), chain.given.end());
    for (double& length : chain.lengths) length = chain.length - length;
    const auto last = static_cast<int>(chain.vertices.size()) - 1;
    for (int& at : chain.given) at = last - at;
}

/// The curves of a mesh that was made with joined ones.
MeshWithCurves taken_apart(const MeshWithCurves& whole, std::span<const CurveThrough> curves, const Order& order) {
    MeshWithCurves result = whole;
    result.curves.assign(curves.size(), {});
    std::size_t first = 0, next_closed = 1;
    for (std::size_t c = 0; c < curves.size(); ++c)
        if (curves[c].closed) result.curves[c] = whole.curves[next_closed++];
    for (const auto& [curve, reversed] : order) {
        const MeshWithCurves::Chain& chain = whole.curves[0];
        const std::size_t last = first + curves[curve].points.size() - 1;
        const int from = chain.given[first], to = chain.given[last];
        MeshWithCurves::Chain& part = result.curves[curve];
        for (int i = from; i <= to; ++i) {
            part.vertices.push_back(chain.vertices[i]);
            part.lengths.push_back(chain.lengths[i] - chain.lengths[from]);
        }
        for (std::size_t g = first; g <= last; ++g) part.given.push_back(chain.given[g] - from);
        part.length = part.lengths.back();
        if (reversed) reverse(part);
        first = last + 1;
    }
    return result;
}

/// Of the straight lines between the curves of an order, in parts of the mesh's size.
double gaps(const Mesh& mesh, std::span<const CurveThrough> curves, const Order& order) {
    const double size = (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
    double sum = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const auto& before = curves[order[i - 1].curve].points;
        const auto& after = curves[order[i].curve].points;
        sum += (point_at(mesh, order[i - 1].reversed ? before.front() : before.back()) -
                point_at(mesh, order[i].reversed ? after.back() : after.front()))
                   .norm();
    }
    return sum / size;
}

/// Orders of open curves, each with all choices of the end at which a curve is begun, but for what is the same
/// backwards; of many curves only the orders in turn.
std::vector<Order> orders_of(const std::vector<std::size_t>& open) {
    std::vector<Order> orders;
    std::vector<std::size_t> next = open;
    const auto add = [&](std::size_t reversals) {
        Order order;
        for (std::size_t i = 0; i < next.size(); ++i) order.push_back({next[i], ((reversals >> i) & 1U) != 0});
        orders.push_back(std::move(order));
    };
    if (open.size() > kMostPermuted) {
        for (std::size_t turn = 0; turn < open.size(); ++turn) {
            add(0);
            std::rotate(next.begin(), next.begin() + 1, next.end());
        }
        return orders;
    }
    do {
        if (next.front() > next.back()) continue;
        for (std::size_t reversals = 0; reversals < (std::size_t{1} << open.size()); ++reversals) add(reversals);
    } while (std::next_permutation(next.begin(), next.end()));
    return orders;
}

/// Of a joined curve's whole way the geodesics that join, in parts of the curves'.
double joins(const MeshWithCurves& whole, const MeshWithCurves& apart) {
    double curves = 0;
    for (const MeshWithCurves::Chain& chain : apart.curves)
        if (!chain.closed) curves += chain.length;
    return whole.curves[0].length / curves;
}

std::vector<Curved> joined_ways(const Mesh& source, const Mesh& target, std::span<const CurveThrough> here,
                                std::span<const CurveThrough> there, const std::vector<std::size_t>& open) {
    std::vector<std::pair<double, Order>> orders;
    for (Order& order : orders_of(open)) {
        const double sum = gaps(source, here, order) + gaps(target, there, order);
        orders.emplace_back(sum, std::move(order));
    }
    std::stable_sort(orders.begin(), orders.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::pair<double, Curved>> found;
    for (std::size_t i = 0; i < std::min(orders.size(), kMostMeasured); ++i) {
        const Order& order = orders[i].second;
        try {
            Curved way;
            way.cut_source = mesh_with_curves(source, joined(here, order));
            way.cut_target = mesh_with_curves(target, joined(there, order));
            way.source = taken_apart(way.cut_source, here, order);
            way.target = taken_apart(way.cut_target, there, order);
            const double length = joins(way.cut_source, way.source) + joins(way.cut_target, way.target);
            found.emplace_back(length, std::move(way));
        } catch (const Error& error) {
            if (error.cause() != Cause::bad_boundary) throw;  // a geodesic meets a curve
        }
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Curved> ways;
    for (std::size_t i = 0; i < std::min(found.size(), kMostWays); ++i) ways.push_back(std::move(found[i].second));
    return ways;
}

}  // namespace

Curved along_curves(const Mesh& source, const Mesh& target, std::span<const CurveThrough> source_curves,
                    std::span<const CurveThrough> target_curves) {
    Curved way;
    way.source = way.cut_source = of_surface("source", source, source_curves);
    way.target = way.cut_target = of_surface("target", target, target_curves);
    return way;
}

std::vector<std::vector<Curved>> ways_to_cut(const Mesh& source, const Mesh& target,
                                             std::span<const CurveThrough> source_curves,
                                             std::span<const CurveThrough> target_curves) {
    std::vector<std::size_t> open;
    for (std::size_t c = 0; c < source_curves.size(); ++c)
        if (!source_curves[c].closed) open.push_back(c);
    std::vector<std::vector<Curved>> groups(1);
    groups[0].push_back(along_curves(source, target, source_curves, target_curves));
    if (open.size() < 2) return groups;
    std::vector<Curved> ways = joined_ways(source, target, source_curves, target_curves, open);
    if (!ways.empty()) groups.push_back(std::move(ways));
    if (open.size() > 2) std::reverse(groups.begin(), groups.end());
    return groups;
}

void measure_curves(MeshWithCurves& mesh, const Positions& points) {
    for (MeshWithCurves::Chain& chain : mesh.curves) {
        chain.length = 0;
        for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
            if (i > 0) chain.length += (points.row(chain.vertices[i]) - points.row(chain.vertices[i - 1])).norm();
            chain.lengths[i] = chain.length;
        }
        if (chain.closed)
            chain.length += (points.row(chain.vertices.front()) - points.row(chain.vertices.back())).norm();
    }
}

}  // namespace beltrami
