#include <beltrami/registration/boundary_match.h>

#include <cmath>
#include <optional>

#include <beltrami/registration/surface_landmarks.h>

namespace beltrami {

namespace {

constexpr double kOff = 1e-9;  // weight of a corner, and part of an edge, that counts as none

/// A place on a boundary loop: that of vertex i is i, between it and the next one a part is added.
struct LoopPlace {
    int loop = -1;
    double at = 0;
};

/// The boundary of the target on its circles.
class Rims {
  public:
    Rims(const Surface& target, const CircleDomainChart& circles)
        : loops_(target.topology.boundary_loops),
          place_of_(static_cast<std::size_t>(target.mesh.vertex_count())),
          angles_(loops_.size()) {
        for (std::size_t l = 0; l < loops_.size(); ++l) {
            circles_.push_back(circles.circle(static_cast<int>(l)));
            const auto arm = [&](std::size_t i) {
                return circles.chart.vertices[loops_[l][i % loops_[l].size()]] - circles_[l].centre;
            };
            angles_[l].push_back(std::arg(arm(0)));
            for (std::size_t i = 0; i < loops_[l].size(); ++i) {
                place_of_[loops_[l][i]] = {static_cast<int>(l), static_cast<double>(i)};
                angles_[l].push_back(angles_[l].back() + std::arg(arm(i + 1) / arm(i)));
            }
        }
    }

    int size(int loop) const { return static_cast<int>(loops_[loop].size()); }
    int vertex(int loop, int i) const { return loops_[loop][i % size(loop)]; }

    /// Nothing for a place that is not on the boundary.
    std::optional<LoopPlace> find(const MeshPoint& place) const {
        LoopPlace ends[2];
        double weights[2];
        int count = 0;
        for (int i = 0; i < 3; ++i) {
            if (!(place.barycentric[i] > kOff)) continue;
            if (count == 2 || place_of_[place.vertices[i]].loop < 0) return {};
            ends[count] = place_of_[place.vertices[i]];
            weights[count++] = place.barycentric[i];
        }
        if (count == 1) return ends[0];
        if (count == 0 || ends[0].loop != ends[1].loop) return {};
        const int n = size(ends[0].loop);
        const auto follows = [&](const LoopPlace& a, const LoopPlace& b) {
            return static_cast<int>(b.at) == (static_cast<int>(a.at) + 1) % n;
        };
        if (!follows(ends[0], ends[1])) std::swap(ends[0], ends[1]), std::swap(weights[0], weights[1]);
        if (!follows(ends[0], ends[1])) return {};
        const double part = weights[1] / (weights[0] + weights[1]);
        if (part < kOff) return ends[0];
        if (part > 1 - kOff) return ends[1];
        return LoopPlace{ends[0].loop, ends[0].at + part};
    }

    double angle(int loop, double at) const {
        const double whole = std::floor(at), turn = angles_[loop].back() - angles_[loop].front();
        const double around = std::floor(whole / size(loop));
        const auto i = static_cast<std::size_t>(whole - around * size(loop));
        return around * turn + angles_[loop][i] + (at - whole) * (angles_[loop][i + 1] - angles_[loop][i]);
    }
    Eigen::Vector3d point(int loop, double at) const {
        const Complex z = circles_[loop].centre + std::polar(circles_[loop].radius, angle(loop, at));
        return {z.real(), z.imag(), 1};
    }

  private:
    const std::vector<std::vector<int>>& loops_;
    std::vector<LoopPlace> place_of_;
    std::vector<RoundHole> circles_;
    std::vector<std::vector<double>> angles_;  ///< of every vertex in order and, once around, of the first again
};

/// Where the vertices of a loop are on a loop of the target, ascending, and once around at the end the first again;
/// empty if they do not run around it once.
std::vector<LoopPlace> places_along(const std::vector<int>& loop, const Rims& rims, std::span<const MeshPoint> places) {
    std::vector<LoopPlace> result;
    for (const int v : loop) {
        const std::optional<LoopPlace> place = rims.find(places[v]);
        if (!place || (!result.empty() && place->loop != result[0].loop)) return {};
        result.push_back(*place);
    }
    const double n = rims.size(result[0].loop), begin = result[0].at;
    for (std::size_t i = 1; i < result.size(); ++i) {
        while (result[i].at < result[i - 1].at) result[i].at += n;
        if (!(result[i].at > result[i - 1].at)) return {};
    }
    if (!(result.back().at < begin + n)) return {};
    result.push_back({result[0].loop, begin + n});
    return result;
}

void match_loop(const std::vector<int>& loop, const std::vector<LoopPlace>& at, const Rims& rims, BoundaryMatch& match,
                int target_vertices, std::vector<int>& partners_of_bends) {
    const int l = at[0].loop, n = rims.size(l);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const int v = loop[i], next = loop[(i + 1) % loop.size()];
        const double from = at[i].at, to = at[i + 1].at, whole = std::floor(from);
        const Eigen::Vector3d point = rims.point(l, from);
        match.source.row(v) = point;
        if (from == whole) {
            match.partners[v] = rims.vertex(l, static_cast<int>(whole));
            match.target.row(match.partners[v]) = point;
        } else {
            match.partners[v] = target_vertices + static_cast<int>(match.target_bends.size());
            const int edge = static_cast<int>(whole);
            match.target_bends.push_back({{rims.vertex(l, edge), rims.vertex(l, edge + 1)}, from - whole, point});
        }
        for (int j = static_cast<int>(whole) + 1; j < to; ++j) {
            const double part = (rims.angle(l, j) - rims.angle(l, from)) / (rims.angle(l, to) - rims.angle(l, from));
            match.source_bends.push_back({{v, next}, part, rims.point(l, j)});
            partners_of_bends.push_back(rims.vertex(l, j % n));
            match.target.row(partners_of_bends.back()) = match.source_bends.back().point;
        }
    }
}

}  // namespace

BoundaryMatch match_boundaries(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                               std::span<const MeshPoint> places) {
    const Eigen::VectorXcd& chart = circles.chart.vertices;
    BoundaryMatch result;
    result.target = Positions::Ones(chart.size(), 3);
    result.target.col(0) = chart.real();
    result.target.col(1) = chart.imag();
    result.source = Positions::Ones(source.mesh.vertex_count(), 3);
    result.partners.assign(places.size(), -1);
    for (std::size_t v = 0; v < places.size(); ++v) {
        const Complex z = places[v].interpolate(chart);
        result.source.row(static_cast<Eigen::Index>(v)) << z.real(), z.imag(), 1;
        if (!source.topology.on_boundary[v]) result.partners[v] = vertex_at(places[v]);
    }
    const Rims rims(target, circles);
    std::vector<int> partners_of_bends;
    for (const std::vector<int>& loop : source.topology.boundary_loops) {
        const std::vector<LoopPlace> at = places_along(loop, rims, places);
        if (!at.empty()) match_loop(loop, at, rims, result, target.mesh.vertex_count(), partners_of_bends);
    }
    result.partners.insert(result.partners.end(), partners_of_bends.begin(), partners_of_bends.end());
    return result;
}

}  // namespace beltrami
