#include <beltrami/unfold/local_unfold.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// Rings of faces around a fold that are moved, one after the other.
constexpr int kRings[] = {3, 6, 12, 24};
/// A patch of more faces, as a part of all, is the whole.
constexpr double kMostOfAll = 0.5;
constexpr double kPatchTolerance = 1e-3;
constexpr int kMostSteps = 200;

/// The faces with so many rings of faces around them, ascending.
std::vector<int> with_rings(const Mesh& mesh, const std::vector<int>& faces, int rings) {
    std::vector<char> near(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const int f : faces)
        for (const int v : mesh.faces[f]) near[v] = 1;
    std::vector<int> result;
    for (int ring = 0; ring < rings; ++ring) {
        result.clear();
        for (int f = 0; f < mesh.face_count(); ++f) {
            const auto face = mesh.faces[f];
            if (std::any_of(face.begin(), face.end(), [&](int v) { return near[v] != 0; })) result.push_back(f);
        }
        for (const int f : result)
            for (const int v : mesh.faces[f]) near[v] = 1;
    }
    return result;
}

Positions metric_of(const Surface& source, const std::vector<int>& faces) {
    std::vector<int> corners;
    for (const int f : faces)
        for (int j = 0; j < source.mesh.faces.degree(f); ++j) corners.push_back(source.mesh.faces.first_corner(f) + j);
    return (*source.metric)(corners, Eigen::all);
}

/// Unfolds a patch, whose rim stays; whether no fold is left.
bool unfold_patch(const Surface& source, const std::vector<Freedom>& freedoms, const std::vector<int>& faces,
                  LocalUnfolding& result) {
    const Submesh part = keep_faces(source.mesh, faces);
    std::optional<Positions> metric;
    if (source.metric) metric = metric_of(source, part.faces);
    const Surface patch = surface_of(part.mesh, std::move(metric));
    const auto n = static_cast<Eigen::Index>(part.vertices.size());
    std::vector<Freedom> free(part.vertices.size(), Freedom::fixed);
    Eigen::VectorXcd start(n);
    for (Eigen::Index v = 0; v < n; ++v) {
        start[v] = result.map[part.vertices[v]];
        if (!patch.topology.on_boundary[v]) free[v] = freedoms[part.vertices[v]];
    }
    const Complex origin = start[0];
    const double size = (start.array() - origin).abs().maxCoeff();
    if (!(size > 0)) return false;
    FoldFreeOptions options;
    options.tolerance = kPatchTolerance;
    options.max_iterations = kMostSteps;
    const FoldFreeMap found = fold_free_map(patch, free, Eigen::VectorXcd::Zero(patch.operators.sample_count()),
                                            (start.array() - origin) / size, options);
    result.factorizations += found.factorizations;
    if (!found.fold_free) return false;
    for (Eigen::Index v = 0; v < n; ++v)
        if (free[v] == Freedom::free) result.map[part.vertices[v]] = origin + size * found.map[v];
    return true;
}

}  // namespace

LocalUnfolding unfold_locally(const Surface& source, const std::vector<Freedom>& freedoms, Eigen::VectorXcd map) {
    LocalUnfolding result;
    result.map = std::move(map);
    result.unfolded = distortion(source.operators, result.map).flipped;
    std::vector<int> folded = result.unfolded;
    for (const int rings : kRings) {
        if (folded.empty()) break;
        const Submesh around = keep_faces(source.mesh, with_rings(source.mesh, folded, rings));
        if (static_cast<double>(around.faces.size()) > kMostOfAll * source.mesh.face_count()) break;
        for (std::vector<int> faces : component_faces(around.mesh)) {
            for (int& f : faces) f = around.faces[f];
            try {
                unfold_patch(source, freedoms, faces, result);
            } catch (const Error& error) {  // a patch that touches itself, or is one point
                if (error.cause() != Cause::bad_mesh && error.cause() != Cause::bad_boundary) throw;
            }
        }
        folded = distortion(source.operators, result.map).flipped;
    }
    result.fold_free = folded.empty();
    return result;
}

}  // namespace beltrami
