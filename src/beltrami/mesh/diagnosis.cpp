#include <beltrami/mesh/diagnosis.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/edge_table.h>

namespace beltrami {
namespace {

constexpr int kListedAtMost = 10;
/// Area over the square of the longest edge below which a face has no area: pure rounding, whatever its size.
constexpr double kZeroAreaRatio = 1e-14;
/// tan of 0.5 degrees.
constexpr double kSliverTangent = 0.008726867790758755;

/// "3, 8, 9 and 12 more": the first few items, where each item is @p width consecutive indices.
std::string list(const std::vector<int>& indices, int width = 1) {
    const int count = static_cast<int>(indices.size()) / width;
    std::string text;
    for (int i = 0; i < std::min(count, kListedAtMost); ++i) {
        if (i > 0) text += ", ";
        text += std::to_string(indices[i * width]);
        for (int j = 1; j < width; ++j) text += "-" + std::to_string(indices[i * width + j]);
    }
    if (count > kListedAtMost) text += " and " + std::to_string(count - kListedAtMost) + " more";
    return text;
}

/// "face 3 names" or "faces 3, 8 name", according to the number of items.
std::string subject(const char* one, const char* many, const std::vector<int>& indices, const char* verb_one,
                    const char* verb_many, int width = 1) {
    const bool single = static_cast<int>(indices.size()) == width;
    return std::string(single ? one : many) + " " + list(indices, width) + " " + (single ? verb_one : verb_many);
}

class Examination {
  public:
    explicit Examination(const Mesh& mesh) : mesh_(mesh), faces_(mesh.faces) {}

    std::vector<Finding> run() {
        if (check_raw_data()) {
            const bool distinct_corners = check_degenerate_faces();
            check_duplicates();
            check_references();
            if (distinct_corners) check_manifold();
            if (finite_) check_shapes();
        }
        std::stable_sort(findings_.begin(), findings_.end(),
                         [](const Finding& a, const Finding& b) { return a.fatal && !b.fatal; });
        return std::move(findings_);
    }

  private:
    void report(Defect defect, bool fatal, std::string sentence, std::string next_step, std::vector<int> indices = {}) {
        findings_.push_back({defect, fatal, std::move(sentence), std::move(next_step), std::move(indices)});
    }

    /// @return false if the indices are so wrong that nothing further can be examined
    bool check_raw_data() {
        if (mesh_.positions.cols() != 2 && mesh_.positions.cols() != 3 && mesh_.vertex_count() > 0) {
            report(Defect::empty, true,
                   "the vertices have " + std::to_string(mesh_.positions.cols()) + " coordinates instead of 2 or 3",
                   "give two or three coordinates a vertex");
            return false;
        }
        if (mesh_.vertex_count() == 0 || mesh_.face_count() == 0) {
            report(Defect::empty, true,
                   mesh_.vertex_count() == 0 ? "the mesh has no vertices" : "the mesh has no faces",
                   "check that the file holds a surface mesh and not only points or curves");
        }
        std::vector<int> wild;
        for (int vertex = 0; vertex < mesh_.vertex_count(); ++vertex) {
            if (!mesh_.positions.row(vertex).allFinite()) wild.push_back(vertex);
        }
        finite_ = wild.empty();
        if (!finite_) {
            report(Defect::not_finite, true,
                   subject("vertex", "vertices", wild, "has a coordinate that is not a finite number",
                           "have coordinates that are not finite numbers"),
                   "write the mesh again without NaN or infinity", wild);
        }
        std::vector<int> wrong_degree, outside;
        for (int face = 0; face < mesh_.face_count(); ++face) {
            if (faces_.degree(face) < 3 || faces_.degree(face) > 4) wrong_degree.push_back(face);
            for (const int vertex : faces_[face]) {
                if (vertex >= 0 && vertex < mesh_.vertex_count()) continue;
                outside.push_back(face);
                break;
            }
        }
        if (!wrong_degree.empty()) {
            report(Defect::too_many_corners, true,
                   subject("face", "faces", wrong_degree, "has", "have") + " fewer than 3 or more than 4 corners",
                   "triangulate the mesh", wrong_degree);
        }
        if (!outside.empty()) {
            report(Defect::index_out_of_range, true,
                   subject("face", "faces", outside, "names", "name") + " a vertex that does not exist (there are " +
                       std::to_string(mesh_.vertex_count()) + " vertices)",
                   "the file is damaged or its indices start elsewhere; write it again", outside);
        }
        return mesh_.face_count() > 0 && wrong_degree.empty() && outside.empty();
    }

    bool check_degenerate_faces() {
        std::vector<int> bad;
        for (int face = 0; face < mesh_.face_count(); ++face) {
            const std::array<int, 4> corners = sorted_corners(face);
            const auto end = corners.begin() + faces_.degree(face);
            if (std::adjacent_find(corners.begin(), end) != end) bad.push_back(face);
        }
        degenerate_.assign(mesh_.face_count(), 0);
        for (const int face : bad) degenerate_[face] = 1;
        if (!bad.empty()) {
            report(Defect::degenerate_face, true, subject("face", "faces", bad, "names", "name") + " a vertex twice",
                   "remove degenerate faces", bad);
        }
        return bad.empty();
    }

    void check_duplicates() {
        // Faces by their smallest corner: duplicates lie among the few of one vertex.
        std::vector<int> offsets(mesh_.vertex_count() + 1, 0);
        for (int face = 0; face < mesh_.face_count(); ++face) ++offsets[smallest_corner(face) + 1];
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        std::vector<std::pair<std::array<int, 4>, int>> keys(mesh_.face_count());
        std::vector<int> end(offsets.begin(), offsets.end() - 1);
        for (int face = 0; face < mesh_.face_count(); ++face)
            keys[end[smallest_corner(face)]++] = {sorted_corners(face), face};
        std::vector<int> bad;
        for (int vertex = 0; vertex < mesh_.vertex_count(); ++vertex) {
            std::sort(keys.begin() + offsets[vertex], keys.begin() + offsets[vertex + 1]);
            for (int i = offsets[vertex] + 1; i < offsets[vertex + 1]; ++i)
                if (keys[i].first == keys[i - 1].first) bad.push_back(keys[i].second);
        }
        std::sort(bad.begin(), bad.end());
        if (!bad.empty()) {
            report(Defect::duplicate_face, true,
                   subject("face", "faces", bad, "has", "have") + " the same corners as an earlier face",
                   "remove duplicate faces", bad);
        }
    }

    void check_references() {
        std::vector<char> referenced(mesh_.vertex_count(), 0);
        DisjointSets sets(mesh_.vertex_count());
        for (int face = 0; face < mesh_.face_count(); ++face) {
            for (const int vertex : faces_[face]) {
                referenced[vertex] = 1;
                sets.join(faces_[face][0], vertex);
            }
        }
        std::vector<int> lonely, roots;
        for (int vertex = 0; vertex < mesh_.vertex_count(); ++vertex) {
            if (!referenced[vertex]) {
                lonely.push_back(vertex);
            } else if (sets.find(vertex) == vertex) {
                roots.push_back(vertex);
            }
        }
        if (!lonely.empty()) {
            report(Defect::unreferenced_vertex, false,
                   subject("vertex", "vertices", lonely, "belongs", "belong") + " to no face",
                   "harmless for most computations; remove_unreferenced drops them", lonely);
        }
        if (roots.size() > 1) {
            report(Defect::several_components, false,
                   "the mesh has " + std::to_string(roots.size()) + " connected components, found at the vertices " +
                       list(roots),
                   "keep one component; largest_component does", roots);
        }
    }

    /// @pre no face names a vertex twice
    void check_manifold() {
        const EdgeTable table = edge_table(faces_, mesh_.vertex_count());
        std::vector<int> bad_edges;
        for (int edge = 0; edge < table.edge_count(); ++edge) {
            if (table.corners_of(edge).size() > 2)
                bad_edges.insert(bad_edges.end(), table.edges[edge].begin(), table.edges[edge].end());
        }
        if (!bad_edges.empty()) {
            report(Defect::non_manifold_edge, true,
                   subject("edge", "edges", bad_edges, "belongs", "belong", 2) + " to more than two faces",
                   "split the surface there, or remove the extra faces", bad_edges);
        }
        const std::vector<int> bad_vertices = non_manifold_vertices(faces_, table, mesh_.vertex_count());
        if (!bad_vertices.empty()) {
            report(Defect::non_manifold_vertex, true,
                   subject("vertex", "vertices", bad_vertices, "joins", "join") +
                       " parts of the surface that share no edge there",
                   "give each part its own copy of the vertex", bad_vertices);
        }
        check_orientation(table);
    }

    /// Spreads an orientation over edges with exactly two faces; a contradiction means that none exists.
    void check_orientation(const EdgeTable& table) {
        const auto disagree = [&](std::span<const int> pair) {
            return faces_.vertices()[pair[0]] == faces_.vertices()[pair[1]];  // both run along the edge the same way
        };
        std::vector<char> flipped(mesh_.face_count(), 2);  // 2: not reached
        std::vector<int> to_flip, queue, contradictions;
        for (int seed = 0; seed < mesh_.face_count(); ++seed) {
            if (flipped[seed] != 2) continue;
            queue.assign(1, seed);
            flipped[seed] = 0;
            std::size_t flips = 0;
            for (std::size_t head = 0; head < queue.size(); ++head) {
                const int face = queue[head];
                flips += flipped[face];
                for (int i = 0; i < faces_.degree(face); ++i) {
                    const std::span<const int> pair =
                        table.corners_of(table.corner_edges[faces_.first_corner(face) + i]);
                    if (pair.size() != 2) continue;
                    const int other =
                        table.corner_faces[pair[0]] == face ? table.corner_faces[pair[1]] : table.corner_faces[pair[0]];
                    if (flipped[other] != 2) continue;
                    flipped[other] = static_cast<char>(flipped[face] ^ (disagree(pair) ? 1 : 0));
                    queue.push_back(other);
                }
            }
            // The minority is wrong.
            const char wrong = 2 * flips > queue.size() ? 0 : 1;
            for (const int face : queue) {
                if (flipped[face] == wrong) to_flip.push_back(face);
            }
        }
        for (int edge = 0; edge < table.edge_count(); ++edge) {
            const std::span<const int> pair = table.corners_of(edge);
            if (pair.size() != 2) continue;
            const bool differ = flipped[table.corner_faces[pair[0]]] != flipped[table.corner_faces[pair[1]]];
            if (differ != disagree(pair)) {
                contradictions.insert(contradictions.end(), table.edges[edge].begin(), table.edges[edge].end());
            }
        }
        std::sort(to_flip.begin(), to_flip.end());
        if (!contradictions.empty()) {
            report(Defect::not_orientable, true,
                   "the surface is one-sided (like a Möbius strip); its orientation breaks at the " +
                       std::string(contradictions.size() == 2 ? "edge " : "edges ") + list(contradictions, 2),
                   "cut the surface there", contradictions);
        } else if (!to_flip.empty()) {
            report(Defect::inconsistent_orientation, true,
                   subject("face", "faces", to_flip, "is", "are") + " oriented against the neighbours",
                   "reverse the order of the corners of these faces", to_flip);
        }
    }

    /// @pre finite positions
    void check_shapes() {
        std::vector<int> zero, slivers, reflex, up, down;
        const bool planar = is_planar(mesh_);
        for (int face = 0; face < mesh_.face_count(); ++face) {
            if (degenerate_[face]) continue;
            const Shape shape = measure(face);
            if (shape.area_ratio < kZeroAreaRatio) {
                zero.push_back(face);
                continue;
            }
            if (faces_.degree(face) == 3 && shape.sliver) slivers.push_back(face);
            if (shape.reflex) reflex.push_back(face);
            if (planar) (shape.upward ? up : down).push_back(face);
        }
        if (!zero.empty()) {
            report(Defect::zero_area_face, true,
                   subject("face", "faces", zero, "has", "have") +
                       " no area (less than 1e-14 of the square of the longest edge)",
                   "collapse or remove these faces", zero);
        }
        if (!up.empty() && !down.empty()) {
            const std::vector<int>& fewer = down.size() <= up.size() ? down : up;
            report(Defect::folded_planar_face, true,
                   subject("face", "faces", fewer, "is", "are") + " flipped in the plane, against the other faces",
                   "unfold the planar mesh, or give it the third coordinate it was projected from", fewer);
        }
        if (!reflex.empty()) {
            report(Defect::reflex_quad, false, subject("quad", "quads", reflex, "is", "are") + " not convex",
                   "split these quads into triangles before they are mapped", reflex);
        }
        if (!slivers.empty()) {
            report(
                Defect::sliver_face, false,
                subject("face", "faces", slivers, "is a sliver", "are slivers") + ", with an angle below 0.5 degrees",
                "results near it lose accuracy; remesh there if they matter", slivers);
        }
    }

    struct Shape {
        double area_ratio;  ///< area / longest edge²
        bool sliver;        ///< has an angle below 0.5 degrees
        bool upward;        ///< normal has positive z
        bool reflex;        ///< a corner of the quad is straight or turns against the others
    };

    /// Measures a face after scaling its longest edge to 1, so that neither huge nor tiny meshes over- or underflow.
    Shape measure(int face) const {
        const std::span<const int> corners = faces_[face];
        const int degree = static_cast<int>(corners.size());
        double scale = 0.0;
        for (const int vertex : corners) scale = std::max(scale, mesh_.point(vertex).cwiseAbs().maxCoeff());
        if (scale == 0.0) return {0.0, false, true, false};
        std::array<Eigen::Vector3d, 4> p;
        for (int i = 0; i < degree; ++i) p[i] = mesh_.point(corners[i]) / scale;
        std::array<Eigen::Vector3d, 4> sides;
        double longest = 0.0;
        for (int i = 0; i < degree; ++i) {
            sides[i] = p[(i + 1) % degree] - p[i];
            longest = std::max(longest, sides[i].cwiseAbs().maxCoeff());
        }
        if (longest == 0.0) return {0.0, false, true, false};
        double longest_square = 0.0;
        for (int i = 0; i < degree; ++i) {
            sides[i] /= longest;
            longest_square = std::max(longest_square, sides[i].squaredNorm());
        }
        Eigen::Vector3d area = 0.5 * sides[0].cross(sides[1]);
        if (degree == 4) area += 0.5 * sides[2].cross(sides[3]);
        bool sliver = false, reflex = false;
        for (int i = 0; i < degree; ++i) {
            const Eigen::Vector3d back = -sides[(i + degree - 1) % degree];
            reflex = reflex || (degree == 4 && sides[i].cross(back).dot(area) < -1e-12);
            sliver = sliver || back.cross(sides[i]).norm() < kSliverTangent * back.dot(sides[i]);
        }
        return {area.norm() / longest_square, sliver, area.z() > 0.0, reflex};
    }

    int smallest_corner(int face) const { return *std::min_element(faces_[face].begin(), faces_[face].end()); }

    std::array<int, 4> sorted_corners(int face) const {
        std::array<int, 4> corners{-1, -1, -1, -1};
        std::copy(faces_[face].begin(), faces_[face].end(), corners.begin());
        std::sort(corners.begin(), corners.begin() + faces_.degree(face));
        return corners;
    }

    const Mesh& mesh_;
    const FaceList& faces_;
    std::vector<Finding> findings_;
    std::vector<char> degenerate_;
    bool finite_ = true;
};

}  // namespace

bool spoils_topology(Defect defect) {
    switch (defect) {
        case Defect::empty:
        case Defect::not_finite:
        case Defect::index_out_of_range:
        case Defect::too_many_corners:
        case Defect::non_manifold_edge:
        case Defect::non_manifold_vertex:
        case Defect::inconsistent_orientation:
        case Defect::not_orientable:
        case Defect::duplicate_face:
        case Defect::degenerate_face:
            return true;
        default:
            return false;
    }
}

namespace {

Things things_of(Defect defect) {
    switch (defect) {
        case Defect::not_finite:
        case Defect::unreferenced_vertex:
        case Defect::several_components:
        case Defect::non_manifold_vertex:
            return Things::vertices;
        case Defect::non_manifold_edge:
        case Defect::not_orientable:
            return Things::edges;
        default:
            return Things::faces;
    }
}

}  // namespace

Where Finding::where() const {
    if (indices.empty()) return {};
    return {things_of(defect), indices};
}

std::vector<Finding> diagnose(const Mesh& mesh) {
    return Examination(mesh).run();
}

std::vector<Finding> require_sound(const Mesh& mesh) {
    std::vector<Finding> findings = diagnose(mesh);
    const auto fatal = std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.fatal; });
    if (fatal == 0) return findings;
    const Finding& first = findings.front();
    std::string sentence = first.sentence;
    if (fatal == 2) sentence += " (and 1 further kind of defect)";
    if (fatal > 2) sentence += " (and " + std::to_string(fatal - 1) + " further kinds of defects)";
    throw Error(Cause::bad_mesh, sentence, first.next_step, first.where());
}

}  // namespace beltrami
