#include <beltrami/applications/grid_on_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include <beltrami/base/counted.h>
#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/plane/segment_tree.h>

namespace beltrami {

namespace {

enum class State : char { outside, border, inside };

/// The image of the surface: where its points are, and its boundary.
struct Image {
    Image(const Surface& source, const Eigen::VectorXcd& map)
        : mesh(image_mesh(source, map)), locator(mesh), boundary(segments(source, map)) {}

    static Mesh image_mesh(const Surface& source, const Eigen::VectorXcd& map) {
        if (map.size() != source.mesh.vertex_count() || !map.allFinite())
            throw Error(Cause::bad_option, "the map has no finite image for every vertex",
                        "give one complex number per vertex");
        Mesh image;
        image.positions.resize(map.size(), 2);
        image.positions.col(0) = map.real();
        image.positions.col(1) = map.imag();
        image.faces = source.mesh.faces;
        std::vector<int> turned;
        for (int f = 0; f < image.face_count(); ++f) {
            const auto v = image.faces[f];
            const std::size_t n = v.size();
            int bad = 0;
            for (std::size_t k = 0; k < n; ++k)
                bad += !(signed_area(map[v[(k + n - 1) % n]], map[v[k]], map[v[(k + 1) % n]]) > 0);
            if (bad > (n == 4 ? 1 : 0)) turned.push_back(f);  // one reflex corner of a quad is none too many
        }
        if (!turned.empty())
            throw Error(Cause::bad_mesh,
                        "the map flips or flattens " + counted(turned.size(), "face", "faces") + ", the first being " +
                            std::to_string(turned[0]),
                        "a grid needs a one-to-one map", {Things::faces, turned});
        return image;
    }

    static std::vector<Segment> segments(const Surface& source, const Eigen::VectorXcd& map) {
        std::vector<Segment> all;
        for (const auto& loop : source.topology.boundary_loops)
            for (std::size_t i = 0; i < loop.size(); ++i)
                all.push_back({map[loop[i]], map[loop[(i + 1) % loop.size()]]});
        return all;
    }

    bool contains(Complex p) const { return locator.locate(p).has_value(); }

    /// The nearest point of the boundary within a distance.
    std::optional<Complex> border_near(Complex p, double reach) const {
        std::optional<Complex> found;
        double least = reach;
        int best = -1;
        const SegmentTree::Box box{p.real() - reach, p.real() + reach, p.imag() - reach, p.imag() + reach};
        boundary.for_each(box, [&](int i) {
            const double away = distance(p, boundary.segments()[i]);
            if (away > least || (away == least && best >= 0 && best < i)) return;
            least = away, best = i;
        });
        if (best < 0) return found;
        const auto& [a, b] = boundary.segments()[best];
        const double t = std::clamp(std::real(std::conj(b - a) * (p - a)) / std::norm(b - a), 0.0, 1.0);
        found = a + t * (b - a);
        return found;
    }

    /// Where the way from a point inside to one outside first meets the boundary.
    Complex first_crossing(Complex from, Complex to) const {
        double first = 1;
        boundary.for_each(SegmentTree::Box::of({from, to}), [&](int i) {
            const auto& [a, b] = boundary.segments()[i];
            const double from_side = signed_area(a, b, from), to_side = signed_area(a, b, to);
            const double a_side = signed_area(from, to, a), b_side = signed_area(from, to, b);
            if (from_side == to_side || (from_side > 0) == (to_side > 0) || (a_side > 0) == (b_side > 0)) return;
            first = std::min(first, from_side / (from_side - to_side));
        });
        return from + first * (to - from);
    }

    Mesh mesh;
    PlanarLocator locator;
    SegmentTree boundary;
};

/// A vertex of the grid before it is numbered.
struct Node {
    Complex place;
    bool on_border;
};

/// A face: its nodes, and the cell.
struct Part {
    std::vector<int> nodes;
    int cell;
};

class Builder {
  public:
    Builder(const Image& image, const Lattice& lattice, const GridOptions& options)
        : image_(image),
          lattice_(lattice),
          options_(options),
          state_(lattice.vertex_count(), State::outside),
          nodes_(lattice.vertex_count()) {
        classify();
        for (int cell = 0; cell < lattice.cell_count(); ++cell) add(cell);
    }

    const std::vector<Node>& nodes() const { return nodes_; }
    const std::vector<Part>& parts() const { return parts_; }
    int whole = 0, trimmed = 0, omitted = 0;

  private:
    /// Shortest edge of the grid at each of its points.
    std::vector<double> shortest_edges() const {
        std::vector<double> shortest(lattice_.vertex_count(), std::numeric_limits<double>::infinity());
        for (int cell = 0; cell < lattice_.cell_count(); ++cell) {
            const std::vector<int> around = lattice_.corners(cell);
            for (std::size_t k = 0; k < around.size(); ++k) {
                const int a = around[k], b = around[(k + 1) % around.size()];
                const double length = std::abs(lattice_.place(b) - lattice_.place(a));
                shortest[a] = std::min(shortest[a], length);
                shortest[b] = std::min(shortest[b], length);
            }
        }
        return shortest;
    }

    /// Tells the grid's points inside from those outside, and moves those near the boundary to it.
    void classify() {
        shortest_ = shortest_edges();
        parallel_for(0, lattice_.vertex_count(), [&](int first, int last) {
            for (int v = first; v < last; ++v) {
                if (!lattice_.is_used(v)) continue;
                const Complex place = lattice_.place(v);
                nodes_[v] = {place, false};
                if (const auto border = image_.border_near(place, options_.snap * shortest_[v])) {
                    state_[v] = State::border;
                    nodes_[v] = {*border, true};
                } else if (image_.contains(place)) {
                    state_[v] = State::inside;
                }
            }
        });
    }

    int crossing(int inside, int outside) {
        const auto [at, added] = crossings_.try_emplace({inside, outside}, static_cast<int>(nodes_.size()));
        if (added) {
            nodes_.push_back({image_.first_crossing(nodes_[inside].place, nodes_[outside].place), true});
        }
        return at->second;
    }

    Complex centre(const std::vector<int>& polygon) const {
        Complex sum = 0;
        for (const int node : polygon) sum += nodes_[node].place;
        return sum / static_cast<double>(polygon.size());
    }

    /// Whether the boundary runs through a convex polygon further from its border nodes and edges than a border that
    /// bends between them would.
    bool is_pierced(const std::vector<int>& polygon, double edge) const {
        const std::size_t n = polygon.size();
        SegmentTree::Box box;
        for (const int node : polygon) box.include(SegmentTree::Box::of({nodes_[node].place, nodes_[node].place}));
        bool pierced = false;
        image_.boundary.for_each(box, [&](int i) {
            if (pierced) return;
            // The part of the segment in the polygon.
            const auto& [a, b] = image_.boundary.segments()[i];
            double begin = 0, end = 1;
            for (std::size_t k = 0; k < n; ++k) {
                const Complex p = nodes_[polygon[k]].place, q = nodes_[polygon[(k + 1) % n]].place;
                const double at_a = signed_area(p, q, a), at_b = signed_area(p, q, b);
                if (at_a < 0 && at_b < 0) return;
                if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
                if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
            }
            if (!(begin < end)) return;
            constexpr double kBend = 0.35;
            for (const double t : {begin, 0.5 * (begin + end), end}) {
                const Complex p = a + t * (b - a);
                double away = std::numeric_limits<double>::infinity();
                for (std::size_t k = 0; k < n; ++k) {
                    const Node &here = nodes_[polygon[k]], &next = nodes_[polygon[(k + 1) % n]];
                    if (!here.on_border) continue;
                    away = std::min(away, distance(p, {here.place, next.on_border ? next.place : here.place}));
                }
                if (away > kBend * edge) pierced = true;
            }
        });
        return pierced;
    }

    void add(int cell) {
        const std::vector<int> around = lattice_.corners(cell);
        const std::size_t n = around.size();
        std::vector<int> polygon;
        double edge = std::numeric_limits<double>::infinity();
        int kept = 0;
        bool is_cut = false;
        for (std::size_t k = 0; k < n; ++k) {
            const int here = around[k], next = around[(k + 1) % n];
            edge = std::min(edge, shortest_[here]);
            if (state_[here] != State::outside) polygon.push_back(here), ++kept;
            is_cut |= state_[here] == State::outside;
            if (state_[here] == State::inside && state_[next] == State::outside)
                polygon.push_back(crossing(here, next));
            if (state_[here] == State::outside && state_[next] == State::inside)
                polygon.push_back(crossing(next, here));
        }
        if (kept == 0) return;
        const bool has_inside =
            std::any_of(around.begin(), around.end(), [&](int v) { return state_[v] == State::inside; });
        if (polygon.size() < 3 || (!has_inside && !image_.contains(centre(polygon)))) return;
        if (is_cut && options_.border == GridOptions::Border::stepped) {
            ++omitted;
            return;
        }
        std::vector<std::vector<int>> polygons{polygon};
        if (polygon.size() == 6 && !image_.contains(centre(polygon))) {
            // Two opposite corners that the outside parts: a triangle at each.
            polygons.clear();
            for (std::size_t k = 0; k < 6; ++k)
                if (polygon[k] < lattice_.vertex_count())
                    polygons.push_back({polygon[(k + 5) % 6], polygon[k], polygon[(k + 1) % 6]});
        }
        for (const auto& part : polygons)
            if (is_pierced(part, edge)) {
                ++omitted;
                return;
            }
        ++(is_cut ? trimmed : whole);
        for (const auto& part : polygons) split(part, cell);
    }

    double smallest_angle(const std::vector<int>& polygon) const {
        double least = std::numbers::pi;
        const std::size_t n = polygon.size();
        for (std::size_t k = 0; k < n; ++k) {
            const Complex here = nodes_[polygon[k]].place;
            least = std::min(least, std::arg((nodes_[polygon[(k + n - 1) % n]].place - here) /
                                             (nodes_[polygon[(k + 1) % n]].place - here)));
        }
        return least;
    }

    /// Cuts a pentagon into a quad and a triangle, a hexagon into two quads, where the smallest angle is largest.
    void split(const std::vector<int>& polygon, int cell) {
        const int n = static_cast<int>(polygon.size());
        if (n <= 4) {
            parts_.push_back({polygon, cell});
            return;
        }
        std::array<std::vector<int>, 2> best;
        double best_angle = -std::numeric_limits<double>::infinity();
        for (int k = 0; k < n; ++k) {
            std::array<std::vector<int>, 2> halves;
            for (int i = 0; i <= 3; ++i) halves[0].push_back(polygon[(k + i) % n]);
            for (int i = 3; i <= n; ++i) halves[1].push_back(polygon[(k + i) % n]);
            const double angle = std::min(smallest_angle(halves[0]), smallest_angle(halves[1]));
            if (angle > best_angle) best_angle = angle, best = halves;
        }
        for (std::vector<int>& half : best) parts_.push_back({std::move(half), cell});
    }

    const Image& image_;
    const Lattice& lattice_;
    const GridOptions& options_;
    std::vector<State> state_;
    std::vector<double> shortest_;
    std::vector<Node> nodes_;  ///< the lattice's, then crossings
    std::vector<Part> parts_;
    std::map<std::pair<int, int>, int> crossings_;
};

/// Numbers the vertices: corners of one node share a number where their parts are joined around it by edges. The parts'
/// nodes become these numbers.
/// @return node of each number
std::vector<int> number_corners(std::vector<Part>& parts) {
    std::vector<int> first{0};
    for (const Part& part : parts) first.push_back(first.back() + static_cast<int>(part.nodes.size()));
    DisjointSets sets(first.back());
    std::map<std::pair<int, int>, std::pair<int, int>> edges;  // (a, b) → the corners of a and of b in a part
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const auto& nodes = parts[p].nodes;
        const int n = static_cast<int>(nodes.size());
        for (int k = 0; k < n; ++k) {
            const int here = first[p] + k, next = first[p] + (k + 1) % n;
            const int a = nodes[k], b = nodes[(k + 1) % n];
            if (const auto other = edges.find({b, a}); other != edges.end()) {
                sets.join(here, other->second.second);
                sets.join(next, other->second.first);
            } else {
                edges[{a, b}] = {here, next};
            }
        }
    }
    std::vector<int> number(first.back(), -1), node_of;
    // Numbered by node, then by first corner.
    std::vector<std::pair<int, int>> corners;
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (std::size_t k = 0; k < parts[p].nodes.size(); ++k)
            corners.emplace_back(parts[p].nodes[k], first[p] + static_cast<int>(k));
    std::sort(corners.begin(), corners.end());
    for (const auto& [node, corner] : corners) {
        int& of_set = number[sets.find(corner)];
        if (of_set < 0) {
            of_set = static_cast<int>(node_of.size());
            node_of.push_back(node);
        }
    }
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (std::size_t k = 0; k < parts[p].nodes.size(); ++k)
            parts[p].nodes[k] = number[sets.find(first[p] + static_cast<int>(k))];
    return node_of;
}

}  // namespace

void GridOptions::validate() const {
    if (!(snap >= 0 && snap <= 0.3))
        throw Error(Cause::bad_option, "snap is " + std::to_string(snap), "give a value from 0 to 0.3");
}

SurfaceGrid grid_on_surface(const Surface& source, const Eigen::VectorXcd& map, const PlaneGrid& grid,
                            const GridOptions& options) {
    options.validate();
    validate(grid);
    require_genus_zero(source);
    const Image image(source, map);
    if (const auto* round = std::get_if<LogPolarGrid>(&grid); round && image.contains(round->centre))
        throw Error(Cause::bad_option, "the centre of the log-polar grid lies in the image",
                    "give a centre in a hole, or a polar grid");
    const Lattice lattice(grid, image.boundary.segments());
    Builder builder(image, lattice, options);
    std::vector<Part> parts = builder.parts();
    if (parts.empty())
        throw Error(Cause::bad_option, "no cell of the grid lies inside the image", "give a smaller spacing");
    const std::vector<int> node_of = number_corners(parts);

    SurfaceGrid result;
    result.whole_cells = builder.whole;
    result.trimmed_cells = builder.trimmed;
    result.omitted_cells = builder.omitted;
    for (const Part& part : parts) {
        result.mesh.faces.add(part.nodes);
        result.cells.push_back(lattice.index(part.cell));
    }
    const int n = static_cast<int>(node_of.size());
    result.parents.resize(n);
    result.parameter.resize(n);
    result.on_border.resize(n);
    result.mesh.positions.resize(n, source.mesh.positions.cols());
    const Positions normals = vertex_normals(source.mesh);
    Positions at_vertices(n, 3);
    parallel_for(
        0, n,
        [&](int begin, int end) {
            for (int v = begin; v < end; ++v) {
                const Node& node = builder.nodes()[node_of[v]];
                result.parameter[v] = node.place;
                result.on_border[v] = node.on_border;
                const MeshPoint parent = image.locator.nearest(node.place);
                result.parents[v] = parent;
                result.mesh.positions.row(v) =
                    point_at(source.mesh, parent).head(result.mesh.positions.cols()).transpose();
                at_vertices.row(v) = point_at(normals, parent).transpose();
            }
        },
        256);
    result.quality = grid_quality(result.mesh, at_vertices);
    return result;
}

}  // namespace beltrami
