#include <beltrami/flow/averaged_patches.h>

#include <beltrami/solve/image_frame.h>
#include <beltrami/solve/target_motion.h>
#include <beltrami/solve/target_step.h>

namespace beltrami {

namespace {

constexpr int kMostRings = 24;

/// #V flags of the vertices of flipped samples.
std::vector<char> flipped_vertices(const Operators& operators, const TargetMap& map) {
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    std::vector<char> result(static_cast<std::size_t>(operators.vertex_count), 0);
    for (int s = 0; s < operators.sample_count(); ++s) {
        if (image_frame(operators, s, points, normals).upright) continue;
        for (const int v : operators.stencil(s)) result[v] = 1;
    }
    return result;
}

/// Adds all vertices of faces that have one.
void add_ring(const FaceList& faces, std::vector<char>& chosen) {
    const std::vector<char> before = chosen;
    for (int f = 0; f < faces.size(); ++f) {
        bool touched = false;
        for (const int v : faces[f]) touched = touched || before[v];
        if (!touched) continue;
        for (const int v : faces[f]) chosen[v] = 1;
    }
}

}  // namespace

int average_flipped_patches(const Surface& source, const Target& target, const std::vector<char>& held,
                            TargetMap& map) {
    int flips = flipped_samples(source.operators, map);
    std::vector<char> patch = flipped_vertices(source.operators, map);
    for (int ring = 0; ring < kMostRings && flips > 0; ++ring) {
        add_ring(source.mesh.faces, patch);
        std::vector<char> at_rest(patch.size());
        std::size_t moving = 0;
        for (std::size_t v = 0; v < patch.size(); ++v) {
            at_rest[v] = !patch[v] || held[v];
            moving += !at_rest[v];
        }
        if (moving == 0) continue;
        if (2 * moving > patch.size()) break;  // no patch, but most of the surface
        const Positions means = extended(*graph_of(source, at_rest), positions_of(map.points));
        TargetMap trial = map;
        for (std::size_t v = 0; v < patch.size(); ++v)
            if (!at_rest[v]) trial.points[v] = target.nearest(means.row(static_cast<Eigen::Index>(v)).transpose());
        const int now = flipped_samples(source.operators, trial);
        if (now >= flips) continue;
        flips = now;
        map = std::move(trial);
        patch = flipped_vertices(source.operators, map);
        ring = -1;
    }
    return flips;
}

}  // namespace beltrami
