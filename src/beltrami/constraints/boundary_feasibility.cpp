#include <beltrami/constraints/boundary_feasibility.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/plane/segment_tree.h>

namespace beltrami {

namespace {

constexpr double kStraightBack = 1e-12;  ///< sine of the largest angle that counts as none
constexpr double kOnSegment = 1e-14;     ///< part of the data's diameter

std::string name(int vertex) {
    return std::to_string(vertex);
}

/// What the map does for certain: the image of a boundary edge with both ends prescribed, or (from = to) of a
/// prescribed vertex beside which there is no such edge.
struct Piece {
    int from, to;
    int loop;  ///< -1: an interior pin
};

class Examination {
  public:
    Examination(const Surface& source, const BoundaryCondition& boundary, int outer)
        : source_(source),
          outer_(outer),
          lines_(boundary.lines),
          image_(prescribed_values(boundary, source)),
          prescribed_(source.mesh.vertex_count(), 0),
          whole_(source.topology.boundary_loops.size(), 1),
          tree_(collect(boundary)) {}

    void run() const {
        no_edge_is_a_point();
        nothing_turns_back();
        nothing_meets();
        orientations();
        places();
        lines();
        faces();
    }

  private:
    const std::vector<std::vector<int>>& loops() const { return source_.topology.boundary_loops; }

    std::vector<Segment> collect(const BoundaryCondition& boundary) {
        std::vector<char> referenced(source_.mesh.vertex_count(), 0);
        for (const int v : source_.mesh.faces.vertices()) referenced[v] = 1;
        for (const int v : boundary.vertices) prescribed_[v] = referenced[v];
        for (int l = 0; l < static_cast<int>(loops().size()); ++l) {
            const auto& loop = loops()[l];
            for (std::size_t i = 0, n = loop.size(); i < n; ++i) {
                const int previous = loop[(i + n - 1) % n], v = loop[i], next = loop[(i + 1) % n];
                if (!prescribed_[v]) {
                    whole_[l] = 0;
                } else if (prescribed_[next]) {
                    pieces_.push_back({v, next, l});
                } else if (!prescribed_[previous]) {
                    pieces_.push_back({v, v, l});
                }
            }
        }
        std::vector<int> pins;
        for (const int v : boundary.vertices)
            if (prescribed_[v] && !source_.topology.on_boundary[v]) pins.push_back(v);
        std::sort(pins.begin(), pins.end());
        for (const int v : pins) pieces_.push_back({v, v, -1});
        std::vector<Segment> segments;
        for (const Piece& piece : pieces_) segments.push_back({image_[piece.from], image_[piece.to]});
        return segments;
    }

    [[noreturn]] static void coincide(int v, int w) {
        throw Error(Cause::bad_boundary,
                    "the boundary values coincide: vertices " + name(v) + " and " + name(w) + " have the same image",
                    "give every vertex an image of its own", {Things::vertices, {v, w}});
    }

    static std::string of_loop(int loop) { return "boundary loop " + std::to_string(loop); }

    void no_edge_is_a_point() const {
        for (const Piece& piece : pieces_)
            if (piece.from != piece.to && image_[piece.from] == image_[piece.to]) coincide(piece.from, piece.to);
    }

    void nothing_turns_back() const {
        for (int l = 0; l < static_cast<int>(loops().size()); ++l) {
            const auto& loop = loops()[l];
            for (std::size_t i = 0, n = loop.size(); i < n; ++i) {
                const int a = loop[i], b = loop[(i + 1) % n], c = loop[(i + 2) % n];
                if (!prescribed_[a] || !prescribed_[b] || !prescribed_[c]) continue;
                const Complex turn = std::conj(image_[b] - image_[a]) * (image_[c] - image_[b]);
                if (turn.real() < 0 && std::abs(turn.imag()) <= -kStraightBack * turn.real())
                    throw Error(Cause::bad_boundary,
                                "the boundary values turn straight back at vertex " + name(b) + " of " + of_loop(l),
                                "no one-to-one map has them; prescribe a simple curve", {Things::vertices, {a, b, c}});
            }
        }
    }

    void nothing_meets() const {
        SegmentTree::Box all;
        for (const Segment& s : tree_.segments()) all.include(SegmentTree::Box::of(s));
        const double margin = kOnSegment * std::max(all.right - all.left, all.high - all.low);
        for (int i = 0; i < static_cast<int>(pieces_.size()); ++i) {
            const Piece& piece = pieces_[i];
            const Segment& segment = tree_.segments()[i];
            const bool pin = piece.loop < 0;
            SegmentTree::Box box = SegmentTree::Box::of(segment);
            if (pin) box.left -= margin, box.right += margin, box.low -= margin, box.high += margin;
            int met = -1;
            tree_.for_each(box, [&](int j) {
                const Piece& other = pieces_[j];
                // Pins stand last and find what they lie on; edges that share a vertex have been compared.
                if ((pin ? j == i : j < i) || (!pin && other.loop < 0) || (met >= 0 && met < j)) return;
                if (piece.from == other.from || piece.from == other.to || piece.to == other.from ||
                    piece.to == other.to)
                    return;
                const Segment& there = tree_.segments()[j];
                if (pin ? distance(segment.a, there) <= margin : segments_meet(segment, there)) met = j;
            });
            if (met >= 0) report_meeting(pieces_[std::min(i, met)], pieces_[std::max(i, met)]);
        }
    }

    [[noreturn]] void report_meeting(const Piece& first, const Piece& second) const {
        for (const int v : {first.from, first.to})
            for (const int w : {second.from, second.to})
                if (image_[v] == image_[w]) coincide(v, w);
        const auto edge = [](const Piece& piece) {
            return piece.from == piece.to ? "vertex " + name(piece.from)
                                          : "edge " + name(piece.from) + "–" + name(piece.to);
        };
        std::vector<int> vertices{first.from, first.to, second.from, second.to};
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        if (second.loop < 0)
            throw Error(
                Cause::bad_boundary,
                "the interior pin at vertex " + name(second.from) + " lies on the image of the boundary " + edge(first),
                "move it into the inside of the target", {Things::vertices, std::move(vertices)});
        if (first.loop == second.loop)
            throw Error(Cause::bad_boundary,
                        "the boundary values of " + of_loop(first.loop) +
                            " run backwards or cross themselves: " + edge(first) + " meets " + edge(second),
                        "no one-to-one map has them; prescribe a simple curve",
                        {Things::vertices, std::move(vertices)});
        throw Error(Cause::bad_boundary,
                    "the images of " + of_loop(first.loop) + " and " + of_loop(second.loop) + " meet: " + edge(first) +
                        " and " + edge(second),
                    "move them apart", {Things::vertices, std::move(vertices)});
    }

    void orientations() const {
        for (int l = 0; l < static_cast<int>(loops().size()); ++l) {
            if (!whole_[l]) continue;
            std::vector<Complex> polygon;
            for (const int v : loops()[l]) polygon.push_back(image_[v]);
            const double area = signed_area(polygon);
            if (l == outer_ ? area > 0 : area < 0) continue;
            throw Error(Cause::bad_boundary,
                        "the boundary values of " + of_loop(l) +
                            (l == outer_ ? ", the outer one, enclose no area or run clockwise"
                                         : ", a hole, enclose no area or run counter-clockwise"),
                        l == outer_ ? "prescribe them counter-clockwise, as the boundary runs with the surface on its "
                                      "left; a mirrored target, or another outer loop, may be meant"
                                    : "prescribe them clockwise, as the hole's boundary runs with the surface on its "
                                      "left; it may be meant as the outer loop",
                        {Things::vertices, loops()[l]});
        }
    }

    /// Every image is inside the outer loop's image and outside all others. What is connected to a boundary loop is
    /// on one side of all others, because nothing meets; so one vertex stands for a run of edges.
    void places() const {
        int previous_to = -1;
        for (const Piece& piece : pieces_) {
            const bool continues = piece.from == previous_to;
            previous_to = piece.to;
            if (continues) continue;
            const Complex p = image_[piece.from];
            std::vector<int> crossed;
            tree_.for_each({p.real(), std::numeric_limits<double>::infinity(), p.imag(), p.imag()}, [&](int j) {
                const Piece& other = pieces_[j];
                if (other.loop < 0 || other.loop == piece.loop || !whole_[other.loop]) return;
                const Segment& s = tree_.segments()[j];
                if ((s.a.imag() <= p.imag()) == (s.b.imag() <= p.imag())) return;
                const double side = signed_area(s.a, s.b, p);
                if (s.a.imag() < s.b.imag() ? side > 0 : side < 0) crossed.push_back(other.loop);
            });
            std::sort(crossed.begin(), crossed.end());
            const auto inside = [&](int l) {
                const auto [first, last] = std::equal_range(crossed.begin(), crossed.end(), l);
                return (last - first) % 2 == 1;
            };
            const std::string what = piece.loop < 0 ? "the interior pin at vertex " + name(piece.from)
                                                    : "the image of " + of_loop(piece.loop) + ", for instance vertex " +
                                                          name(piece.from) + ",";
            if (!whole_.empty() && piece.loop != outer_ && whole_[outer_] && !inside(outer_))
                throw Error(Cause::bad_boundary,
                            what + " lies outside the image of " + of_loop(outer_) + ", the outer one",
                            "move it inside, or name another outer loop", {Things::vertices, {piece.from}});
            for (std::size_t k = 0; k < crossed.size(); ++k)
                if (crossed[k] != outer_ && inside(crossed[k]))
                    throw Error(Cause::bad_boundary,
                                what + " lies inside the image of " + of_loop(crossed[k]) + ", a hole",
                                "move one of them", {Things::vertices, {piece.from, loops()[crossed[k]][0]}});
        }
    }

    /// A line meets the inside of a simple polygon exactly where corners lie on both its sides, and just within its
    /// first crossing it is outside every hole.
    void lines() const {
        if (whole_.empty() || !whole_[outer_]) return;
        for (const BoundaryCondition::Line& line : lines_) {
            double left = 0, right = 0, reach = 0;
            for (const int v : loops()[outer_]) {
                const Complex to = std::conj(line.direction) * (image_[v] - line.point);
                left = std::max(left, to.imag());
                right = std::max(right, -to.imag());
                reach = std::max(reach, std::abs(to));
            }
            if (left > kOnSegment * reach && right > kOnSegment * reach) continue;
            throw Error(Cause::bad_boundary,
                        "the line on which vertex " + name(line.vertex) + " is to lie misses the image of " +
                            of_loop(outer_) + ", the outer one",
                        "give a line that crosses it", {Things::vertices, {line.vertex}});
        }
    }

    void faces() const {
        const FaceList& faces = source_.mesh.faces;
        for (int f = 0; f < faces.size(); ++f) {
            const auto v = faces[f];
            bool alone = true;
            for (int c = faces.first_corner(f); c < faces.first_corner(f) + faces.degree(f); ++c) {
                const auto& sides = source_.topology.edge_faces[source_.topology.corner_edges[c]];
                alone = alone && prescribed_[faces.vertices()[c]] && (sides[0] < 0 || sides[1] < 0);
            }
            if (!alone) continue;
            const std::size_t n = v.size();
            for (std::size_t i = 0; i < n; ++i)
                if (!(signed_area(image_[v[i]], image_[v[(i + 1) % n]], image_[v[(i + 2) % n]]) > 0))
                    throw Error(Cause::bad_boundary,
                                "face " + std::to_string(f) +
                                    " has no interior edge and its prescribed image folds at "
                                    "vertex " +
                                    name(v[(i + 1) % n]),
                                "prescribe a convex image, counter-clockwise, or split the face",
                                {Things::vertices, {v.begin(), v.end()}});
        }
    }

    const Surface& source_;
    int outer_;
    const std::vector<BoundaryCondition::Line>& lines_;
    Eigen::VectorXcd image_;
    std::vector<char> prescribed_, whole_;
    std::vector<Piece> pieces_;
    SegmentTree tree_;
};

}  // namespace

void require_feasible(const Surface& source, const BoundaryCondition& boundary, int outer_loop) {
    validate(boundary, source);
    const Topology& topology = source.topology;
    if (topology.components != 1 || topology.genus != 0)
        throw Error(Cause::bad_mesh,
                    "the surface has " + std::to_string(topology.components) + " components and genus " +
                        std::to_string(topology.genus) + "; it does not fit into the plane",
                    "cut it until one component of genus 0 is left");
    const int count = static_cast<int>(topology.boundary_loops.size());
    if (count > 0 && (outer_loop < 0 || outer_loop >= count))
        throw Error(Cause::bad_option,
                    "there is no boundary loop " + std::to_string(outer_loop) + " to be the outer one",
                    "the loops are counted from 0 to " + std::to_string(count - 1));
    Examination(source, boundary, outer_loop).run();
}

}  // namespace beltrami
