#include <beltrami/mesh/repair.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/diagnosis.h>

namespace beltrami {

namespace {

/// A cube of space with sides as long as the tolerance; whole numbers, far from the origin rounded ones.
using Cell = std::array<double, 3>;

/// The vertices sorted by their cells.
std::vector<std::pair<Cell, int>> sorted_cells(const Mesh& mesh, double side) {
    std::vector<std::pair<Cell, int>> cells;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        if (!p.allFinite()) continue;  // at no place
        Cell cell;
        for (int i = 0; i < 3; ++i) cell[i] = (side > 0 ? std::floor(p[i] / side) : p[i]) + 0.0;
        cells.emplace_back(cell, v);
    }
    std::sort(cells.begin(), cells.end());
    return cells;
}

/// Joins the vertices of a cell with those of the cells around it that are near enough.
void join_near(const Mesh& mesh, double tolerance, DisjointSets& sets) {
    const auto cells = sorted_cells(mesh, tolerance);
    const auto join = [&](int v, int w) {
        if ((mesh.point(v) - mesh.point(w)).stableNorm() <= tolerance) sets.join(v, w);
    };
    for (std::size_t first = 0, last = 0; first < cells.size(); first = last) {
        const Cell& cell = cells[first].first;
        while (last < cells.size() && cells[last].first == cell) ++last;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = i + 1; j < last; ++j) join(cells[i].second, cells[j].second);
        if (tolerance == 0) continue;
        for (int step = 14; step < 27; ++step) {  // half of the neighbours; the others find this one
            const Cell other{cell[0] + step / 9 - 1, cell[1] + step / 3 % 3 - 1, cell[2] + step % 3 - 1};
            const auto at_least = [&](const std::pair<Cell, int>& entry, const Cell& key) { return entry.first < key; };
            auto near = std::lower_bound(cells.begin(), cells.end(), other, at_least);
            for (; near != cells.end() && near->first == other; ++near)
                for (std::size_t i = first; i < last; ++i) join(cells[i].second, near->second);
        }
    }
}

/// Components of the faces, across common vertices.
int component_count(const Mesh& mesh) {
    DisjointSets sets(mesh.vertex_count());
    std::vector<char> used(mesh.vertex_count(), 0);
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) {
            sets.join(mesh.faces[f][0], v);
            used[v] = 1;
        }
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) count += used[v] && sets.find(v) == v;
    return count;
}

}  // namespace

WeldedMesh weld(const Mesh& mesh, double tolerance) {
    if (!(tolerance >= 0 && std::isfinite(tolerance)))
        throw Error(Cause::bad_option, "the distance within which vertices are welded must be a number from 0");
    DisjointSets sets(mesh.vertex_count());
    join_near(mesh, tolerance, sets);
    WeldedMesh result;
    std::vector<int> of_root(mesh.vertex_count(), -1);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        int& vertex = of_root[sets.find(v)];
        if (vertex < 0) {
            vertex = static_cast<int>(result.vertices.size());
            result.vertices.push_back(v);
        }
        result.welded.push_back(vertex);
    }
    result.mesh.positions.resize(static_cast<Eigen::Index>(result.vertices.size()), mesh.positions.cols());
    for (std::size_t v = 0; v < result.vertices.size(); ++v)
        result.mesh.positions.row(static_cast<Eigen::Index>(v)) = mesh.positions.row(result.vertices[v]);
    std::vector<int> texture;
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::vector<int> vertices, points;
        const int first = mesh.faces.first_corner(f), degree = mesh.faces.degree(f);
        for (int c = 0; c < degree; ++c) {
            const int v = result.welded[mesh.faces[f][c]];
            if (v == result.welded[mesh.faces[f][(c + 1) % degree]]) continue;
            vertices.push_back(v);
            if (mesh.texture) points.push_back(mesh.texture->corners[first + c]);
        }
        // Corners that are not neighbours may have met too.
        std::vector<int> sorted = vertices;
        std::sort(sorted.begin(), sorted.end());
        if (vertices.size() < 3 || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
            ++result.removed_faces;
            continue;
        }
        result.mesh.faces.add(vertices);
        result.faces.push_back(f);
        texture.insert(texture.end(), points.begin(), points.end());
    }
    if (mesh.texture) result.mesh.texture = TextureCoordinates{mesh.texture->points, std::move(texture)};
    return result;
}

WeldSuggestion suggest_weld(const Mesh& mesh) {
    WeldSuggestion best{0, component_count(mesh)};
    if (mesh.vertex_count() == 0 || !mesh.positions.allFinite()) return best;
    const double diameter = (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).stableNorm();
    int vertices = -1;  // with the tolerance before
    bool settled = false;
    for (const double part : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
        const WeldedMesh welded = weld(mesh, part * diameter);
        if (welded.removed_faces > 0) break;
        const int left = component_count(welded.mesh);
        settled = settled || (left == best.components && welded.mesh.vertex_count() == vertices);
        if (left < best.components || (left == best.components && best.tolerance > 0 && !settled)) {
            best = {part * diameter, left};
            settled = false;
        }
        vertices = welded.mesh.vertex_count();
    }
    return best;
}

OrientedMesh orient(const Mesh& mesh) {
    OrientedMesh result{mesh, {}};
    for (const Finding& finding : diagnose(mesh)) {
        switch (finding.defect) {
            case Defect::inconsistent_orientation:
                result.turned = finding.indices;
                break;
            case Defect::not_orientable:
            case Defect::non_manifold_edge:
            case Defect::degenerate_face:
            case Defect::index_out_of_range:
                throw Error(Cause::bad_mesh, finding.sentence, finding.next_step, finding.where());
            default:
                break;
        }
    }
    if (result.turned.empty()) return result;
    std::vector<char> turned(mesh.face_count(), 0);
    for (const int f : result.turned) turned[f] = 1;
    FaceList faces;
    faces.reserve(mesh.face_count(), mesh.faces.corner_count());
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::vector<int> vertices(mesh.faces[f].begin(), mesh.faces[f].end());
        if (turned[f]) {
            std::reverse(vertices.begin() + 1, vertices.end());
            if (result.mesh.texture) {
                const auto first = result.mesh.texture->corners.begin() + mesh.faces.first_corner(f);
                std::reverse(first + 1, first + mesh.faces.degree(f));
            }
        }
        faces.add(vertices);
    }
    result.mesh.faces = std::move(faces);
    return result;
}

}  // namespace beltrami
