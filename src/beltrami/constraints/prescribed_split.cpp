#include <beltrami/constraints/prescribed_split.h>

#include <algorithm>
#include <numbers>

#include <beltrami/plane/polygon.h>
#include <beltrami/plane/segment_tree.h>

namespace beltrami {

namespace {

/// Which edges to split.
class Choice {
  public:
    std::vector<char> split;  ///< #E

    Choice(const Surface& source, const BoundaryCondition& boundary)
        : split(source.topology.edge_count(), 0), source_(source), prescribed_(source.mesh.vertex_count(), 0) {
        for (const int v : boundary.vertices) prescribed_[v] = 1;
        bridges();
        prescribed_faces();
        blocked(boundary);
    }

  private:
    bool interior(int e) const {
        return source_.topology.edge_faces[e][0] >= 0 && source_.topology.edge_faces[e][1] >= 0;
    }
    bool nailed(int e) const {
        return interior(e) && prescribed_[source_.topology.edges[e][0]] && prescribed_[source_.topology.edges[e][1]];
    }

    void bridges() {
        const auto& on_boundary = source_.topology.on_boundary;
        for (int e = 0; e < source_.topology.edge_count(); ++e) {
            const auto [a, b] = source_.topology.edges[e];
            split[e] = nailed(e) && on_boundary[a] && on_boundary[b];
        }
    }

    double length(int corner, int next) const {
        if (source_.metric) return (source_.metric->row(corner) - source_.metric->row(next)).norm();
        const auto& vertices = source_.mesh.faces.vertices();
        return (source_.mesh.point(vertices[corner]) - source_.mesh.point(vertices[next])).norm();
    }

    void prescribed_faces() {
        const FaceList& faces = source_.mesh.faces;
        std::vector<int> nominated;
        for (int f = 0; f < faces.size(); ++f) {
            const int first = faces.first_corner(f), degree = faces.degree(f);
            bool open = false;
            int longest = -1;
            double longest_length = 0;
            for (int i = 0; i < degree && !open; ++i) {
                const int e = source_.topology.corner_edges[first + i];
                open = !prescribed_[faces.vertices()[first + i]] || split[e];
                if (open || !interior(e)) continue;
                const double here = length(first + i, first + (i + 1) % degree);
                if (longest < 0 || here > longest_length || (here == longest_length && e < longest))
                    longest = e, longest_length = here;
            }
            if (!open && longest >= 0) nominated.push_back(longest);
        }
        for (const int e : nominated) split[e] = 1;
    }

    void blocked(const BoundaryCondition& boundary) {
        const Topology& topology = source_.topology;
        const Eigen::VectorXcd image = prescribed_values(boundary, source_);
        std::vector<int> candidates;
        for (int e = 0; e < topology.edge_count(); ++e)
            if (nailed(e) && !split[e]) candidates.push_back(e);
        if (candidates.empty()) return;
        std::vector<std::array<int, 2>> pieces;
        for (const int e : candidates) pieces.push_back(topology.edges[e]);
        for (int e = 0; e < topology.edge_count(); ++e)
            if (!interior(e) && prescribed_[topology.edges[e][0]] && prescribed_[topology.edges[e][1]])
                pieces.push_back(topology.edges[e]);
        for (const int v : boundary.vertices) pieces.push_back({v, v});
        std::vector<Segment> segments;
        for (const auto& [a, b] : pieces) segments.push_back({image[a], image[b]});
        const SegmentTree tree(std::move(segments));
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const auto [a, b] = pieces[i];
            const Segment& segment = tree.segments()[i];
            bool meets = false;
            tree.for_each(SegmentTree::Box::of(segment), [&](int j) {
                const auto [c, d] = pieces[j];
                if (meets || static_cast<int>(i) == j || ((c == a || c == b) && (d == a || d == b))) return;
                const bool begins = c == a || d == a, ends = c == b || d == b;
                if (!begins && !ends) {
                    meets = segments_meet(segment, tree.segments()[j]);
                    return;
                }
                // With one end in common they meet elsewhere only if they leave it in the same direction.
                const Complex common = begins ? image[a] : image[b], here = (begins ? image[b] : image[a]) - common;
                const Complex there = image[c == a || c == b ? d : c] - common, turn = std::conj(here) * there;
                meets = turn.imag() == 0 && turn.real() > 0;
            });
            if (meets) split[candidates[i]] = 1;
        }
    }

    const Surface& source_;
    std::vector<char> prescribed_;
};

/// One new face, as points of its old face: corner i is i, the middle of the edge from corner i is degree + i, the
/// centre 2·degree.
using Parts = std::vector<std::array<int, 3>>;

/// The triangles of a triangle with some edges split. Of the two diagonals that two split edges leave open the shorter
/// one is taken.
template <class Distance>
Parts triangle_parts(const std::array<bool, 4>& split, const Distance& distance) {
    const int count = split[0] + split[1] + split[2];
    if (count == 3) return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    if (count == 1) {
        const int i = split[0] ? 0 : split[1] ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
        return {{i, 3 + i, k}, {3 + i, j, k}};
    }
    // Edge i is whole: corner k is cut off, and a quad of corners i, j and the middles of jk and ki is left.
    const int i = !split[0] ? 0 : !split[1] ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
    const int right = 3 + j, left = 3 + k;
    if (distance(i, right) <= distance(j, left)) return {{k, left, right}, {i, j, right}, {i, right, left}};
    return {{k, left, right}, {i, j, left}, {j, right, left}};
}

Parts quad_parts(const std::array<bool, 4>& split) {
    Parts parts;
    for (int i = 0; i < 4; ++i) {
        if (split[i]) {
            parts.push_back({i, 4 + i, 8});
            parts.push_back({4 + i, (i + 1) % 4, 8});
        } else {
            parts.push_back({i, (i + 1) % 4, 8});
        }
    }
    return parts;
}

/// The point of a face's part, from one row per corner.
template <class Rows>
Eigen::Vector3d part_point(const Rows& corner_row, int degree, int part) {
    if (part < degree) return corner_row(part);
    if (part < 2 * degree) return 0.5 * (corner_row(part - degree) + corner_row((part - degree + 1) % degree));
    return 0.25 * (corner_row(0) + corner_row(1) + corner_row(2) + corner_row(3));
}

/// Texture points of split faces. A middle belongs to the two texture points it lies between, so faces that share
/// these share it, and a seam stays a seam.
class TextureSplit {
  public:
    TextureSplit(const TextureCoordinates& old, int edges) : old_(old), of_edge_(edges, {-1, -1}) {
        for (Eigen::Index i = 0; i < old.points.rows(); ++i) points_.emplace_back(old.points.row(i).head<2>());
    }
    /// The texture point of a part of a face with the first corner @p first; @p edge if the part is its middle.
    int part(int first, int degree, int part, int edge) {
        const auto corner = [&](int i) {
            const std::size_t c = static_cast<std::size_t>(first) + i;
            const int index = c < old_.corners.size() ? old_.corners[c] : -1;
            return index < old_.points.rows() ? index : -1;
        };
        if (part < degree) return corner(part);
        const int whole = part < 2 * degree ? 2 : 4;
        const int begin = part < 2 * degree ? part - degree : 0;
        Eigen::RowVector2d mean = Eigen::RowVector2d::Zero();
        for (int i = 0; i < whole; ++i) {
            const int index = corner((begin + i) % degree);
            if (index < 0) return -1;
            mean += old_.points.row(index).head<2>() / whole;
        }
        if (whole == 4) return add(mean);
        const auto [low, high] = std::minmax({corner(begin), corner((begin + 1) % degree)});
        const std::array<int, 2> ends{low, high};
        for (int& known : of_edge_[edge]) {
            if (known >= 0 && middles_[known - old_.points.rows()] == ends) return known;
            if (known < 0) return known = add(mean, ends);
        }
        return add(mean, ends);
    }
    TextureCoordinates finish(std::vector<int> corners) const {
        TextureCoordinates result{Positions(static_cast<Eigen::Index>(points_.size()), 2), std::move(corners)};
        for (std::size_t i = 0; i < points_.size(); ++i) result.points.row(static_cast<Eigen::Index>(i)) = points_[i];
        return result;
    }

  private:
    int add(const Eigen::RowVector2d& point, std::array<int, 2> ends = {-1, -1}) {
        points_.push_back(point);
        middles_.push_back(ends);
        return static_cast<int>(points_.size()) - 1;
    }

    const TextureCoordinates& old_;
    std::vector<std::array<int, 2>> of_edge_;  ///< the one or two middles of a split edge
    std::vector<Eigen::RowVector2d> points_;
    std::vector<std::array<int, 2>> middles_;  ///< of each added point the two it lies between
};

}  // namespace

SplitProblem split_prescribed(const Surface& source, const BoundaryCondition& boundary) {
    const Mesh& old = source.mesh;
    const Topology& topology = source.topology;
    const std::vector<char> split = Choice(source, boundary).split;
    SplitProblem result;
    result.split_edges = static_cast<int>(std::count(split.begin(), split.end(), char(1)));
    if (result.split_edges == 0) {
        result.mesh = old;
        result.metric = source.metric;
        for (int f = 0; f < old.face_count(); ++f) result.face_parents.push_back(f);
        return result;
    }
    std::vector<int> middle(split.size(), -1);
    for (std::size_t e = 0; e < split.size(); ++e) {
        if (!split[e]) continue;
        middle[e] = old.vertex_count() + static_cast<int>(result.parents.size());
        result.parents.push_back({topology.edges[e][0], topology.edges[e][1], -1, -1});
    }

    std::vector<Eigen::Vector3d> metric;
    std::optional<TextureSplit> texture;
    if (old.texture) texture.emplace(*old.texture, topology.edge_count());
    std::vector<int> texture_corners;
    for (int f = 0; f < old.face_count(); ++f) {
        const int first = old.faces.first_corner(f), degree = old.faces.degree(f);
        const auto vertices = old.faces[f];
        std::array<bool, 4> cut{};
        for (int i = 0; i < degree; ++i) cut[i] = split[topology.corner_edges[first + i]];
        const bool any = cut[0] || cut[1] || cut[2] || cut[3];
        const auto shape = [&](int i) -> Eigen::Vector3d {
            if (!source.metric) return old.point(vertices[i]);
            const auto row = source.metric->row(first + i);
            return {row[0], row[1], row.cols() > 2 ? row[2] : 0.0};
        };
        int centre = -1, texture_centre = -1;
        if (any && degree == 4) {
            centre = old.vertex_count() + static_cast<int>(result.parents.size());
            result.parents.push_back({vertices[0], vertices[1], vertices[2], vertices[3]});
            if (texture) texture_centre = texture->part(first, degree, 2 * degree, -1);
        }
        const auto add_corner = [&](int part) {
            const int edge = part >= degree && part < 2 * degree ? topology.corner_edges[first + part - degree] : -1;
            if (source.metric) metric.push_back(part_point(shape, degree, part));
            if (texture)
                texture_corners.push_back(part == 2 * degree ? texture_centre
                                                             : texture->part(first, degree, part, edge));
            return part < degree ? vertices[part] : part == 2 * degree ? centre : middle[edge];
        };
        if (!any) {
            for (int i = 0; i < degree; ++i) add_corner(i);
            result.mesh.faces.add(vertices);
            result.face_parents.push_back(f);
            continue;
        }
        const Parts parts = degree == 4 ? quad_parts(cut) : triangle_parts(cut, [&](int i, int j) {
            return (part_point(shape, degree, i) - part_point(shape, degree, j)).norm();
        });
        for (const auto& [a, b, c] : parts) {
            const int va = add_corner(a), vb = add_corner(b), vc = add_corner(c);
            result.mesh.faces.add({va, vb, vc});
            result.face_parents.push_back(f);
        }
    }

    result.mesh.positions.resize(old.vertex_count() + static_cast<Eigen::Index>(result.parents.size()),
                                 old.positions.cols());
    result.mesh.positions.topRows(old.vertex_count()) = old.positions;
    for (std::size_t i = 0; i < result.parents.size(); ++i) {
        const auto& [a, b, c, d] = result.parents[i];
        auto row = result.mesh.positions.row(old.vertex_count() + static_cast<Eigen::Index>(i));
        row = 0.5 * (old.positions.row(a) + old.positions.row(b));
        if (c >= 0) row = 0.5 * row + 0.25 * (old.positions.row(c) + old.positions.row(d));
    }
    if (source.metric) {
        result.metric.emplace(static_cast<Eigen::Index>(metric.size()), source.metric->cols());
        for (std::size_t i = 0; i < metric.size(); ++i)
            result.metric->row(static_cast<Eigen::Index>(i)) = metric[i].head(source.metric->cols()).transpose();
    }
    if (texture) result.mesh.texture = texture->finish(std::move(texture_corners));
    return result;
}

SplitProblem split_bridges(const Surface& source) {
    // Any values will do: every edge whose image could matter is a bridge.
    BoundaryCondition boundary;
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const double turn = 2 * std::numbers::pi / static_cast<double>(loops[l].size());
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            boundary.pin(loops[l][i], std::polar(1.0 + static_cast<double>(l), turn * static_cast<double>(i)));
    }
    return split_prescribed(source, boundary);
}

}  // namespace beltrami
