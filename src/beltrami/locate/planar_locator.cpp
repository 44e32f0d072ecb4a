#include <beltrami/locate/planar_locator.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/base/error.h>
#include <beltrami/mesh/quad_split.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Barycentric coordinates this far below 0 still count as inside: rounding must not open gaps between faces.
constexpr double kSlack = 1e-12;

}  // namespace

PlanarLocator::PlanarLocator(const Mesh& mesh) {
    if (!is_planar(mesh) || mesh.faces.empty())
        throw Error(Cause::bad_mesh, "points can be located in a planar mesh with faces only",
                    "give a mesh whose z are all 0");
    for (int v = 0; v < mesh.vertex_count(); ++v) points_.emplace_back(mesh.positions(v, 0), mesh.positions(v, 1));
    double x1 = -std::numeric_limits<double>::infinity(), y1 = x1;
    x0_ = y0_ = std::numeric_limits<double>::infinity();
    for (const int v : mesh.faces.vertices()) {
        x0_ = std::min(x0_, points_[v].real());
        x1 = std::max(x1, points_[v].real());
        y0_ = std::min(y0_, points_[v].imag());
        y1 = std::max(y1, points_[v].imag());
    }
    diameter_ = std::hypot(x1 - x0_, y1 - y0_);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        if (v.size() == 3) {
            triangles_.push_back({f, {v[0], v[1], v[2]}});
        } else {
            for (const auto& [a, b, c] : split_inside({points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]}))
                triangles_.push_back({f, {v[a], v[b], v[c]}});
        }
    }

    // Edges that occur once are the border.
    struct Side {
        int a, b, triangle, edge;
    };
    std::vector<Side> sides;
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
        for (int e = 0; e < 3; ++e) {
            const auto [a, b] = std::minmax(triangles_[t].vertices[e], triangles_[t].vertices[(e + 1) % 3]);
            sides.push_back({a, b, t, e});
        }
    const auto before = [](const Side& s, const Side& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; };
    std::sort(sides.begin(), sides.end(), before);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t next = i + 1;
        while (next < sides.size() && !before(sides[i], sides[next])) ++next;
        if (next == i + 1) border_.push_back({sides[i].triangle, sides[i].edge});
        i = next;
    }

    // About one bucket per triangle.
    const double area = std::max((x1 - x0_) * (y1 - y0_), 1e-30 * diameter_ * diameter_);
    cell_ = std::sqrt(area / static_cast<double>(triangles_.size()));
    if (!(cell_ > 0)) cell_ = 1;
    columns_ = std::max(1, static_cast<int>(std::min(4096.0, (x1 - x0_) / cell_)) + 1);
    rows_ = std::max(1, static_cast<int>(std::min(4096.0, (y1 - y0_) / cell_)) + 1);
    cell_ = std::max((x1 - x0_) / columns_, (y1 - y0_) / rows_) * (1 + 1e-12);
    if (!(cell_ > 0)) cell_ = 1;
    const auto for_buckets = [&](const Triangle& t, const auto& visit) {
        const Complex p = points_[t.vertices[0]], q = points_[t.vertices[1]], r = points_[t.vertices[2]];
        const int c0 = column(std::min({p.real(), q.real(), r.real()})),
                  c1 = column(std::max({p.real(), q.real(), r.real()}));
        const int r0 = row(std::min({p.imag(), q.imag(), r.imag()})),
                  r1 = row(std::max({p.imag(), q.imag(), r.imag()}));
        for (int j = r0; j <= r1; ++j)
            for (int i = c0; i <= c1; ++i) visit(j * columns_ + i);
    };
    offsets_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
    for (const Triangle& t : triangles_) for_buckets(t, [&](int bucket) { ++offsets_[bucket + 1]; });
    for (std::size_t b = 1; b < offsets_.size(); ++b) offsets_[b] += offsets_[b - 1];
    contents_.resize(offsets_.back());
    std::vector<int> fill(offsets_.begin(), offsets_.end() - 1);
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
        for_buckets(triangles_[t], [&](int bucket) { contents_[fill[bucket]++] = t; });
}

int PlanarLocator::column(double x) const {
    return std::clamp(static_cast<int>((x - x0_) / cell_), 0, columns_ - 1);
}
int PlanarLocator::row(double y) const {
    return std::clamp(static_cast<int>((y - y0_) / cell_), 0, rows_ - 1);
}

std::array<double, 3> PlanarLocator::barycentric(const Triangle& triangle, Complex point) const {
    const Complex a = points_[triangle.vertices[0]], b = points_[triangle.vertices[1]],
                  c = points_[triangle.vertices[2]];
    const double area = cross(b - a, c - a);
    const double u = cross(b - point, c - point) / area, v = cross(c - point, a - point) / area;
    return {u, v, 1 - u - v};
}

std::optional<MeshPoint> PlanarLocator::locate(Complex point) const {
    const double x = point.real(), y = point.imag();
    if (!(x >= x0_ - cell_ && x <= x0_ + (columns_ + 1) * cell_ && y >= y0_ - cell_ && y <= y0_ + (rows_ + 1) * cell_))
        return {};
    const int bucket = row(y) * columns_ + column(x);
    for (int i = offsets_[bucket]; i < offsets_[bucket + 1]; ++i) {
        const Triangle& t = triangles_[contents_[i]];
        const auto weights = barycentric(t, point);
        // One by one: weights of a collapsed triangle are no numbers, and compare as false.
        if (weights[0] >= -kSlack && weights[1] >= -kSlack && weights[2] >= -kSlack)
            return MeshPoint{t.face, t.vertices, weights};
    }
    return {};
}

MeshPoint PlanarLocator::nearest(Complex point) const {
    if (const auto inside = locate(point)) return *inside;
    MeshPoint best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [t, e] : border_) {
        const Triangle& triangle = triangles_[t];
        const Complex a = points_[triangle.vertices[e]], b = points_[triangle.vertices[(e + 1) % 3]];
        const double s = std::clamp(std::real(std::conj(b - a) * (point - a)) / std::norm(b - a), 0.0, 1.0);
        const double distance = std::norm(a + s * (b - a) - point);
        if (distance < least) {
            least = distance;
            best = {triangle.face, triangle.vertices, {}};
            best.barycentric[e] = 1 - s;
            best.barycentric[(e + 1) % 3] = s;
        }
    }
    return best;
}

}  // namespace beltrami
