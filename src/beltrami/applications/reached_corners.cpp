#include <beltrami/applications/reached_corners.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Corners that turn by less (radians) are none.
constexpr double kSharp = 1e-6;

/// Whether the faces around a vertex are counter-clockwise and convex there; all of them triangles or quads.
bool unfolded(const Surface& source, const std::vector<int>& faces, const Eigen::VectorXcd& map) {
    for (const int f : faces) {
        const auto v = source.mesh.faces[f];
        const std::size_t n = v.size();
        for (std::size_t k = 0; k < n; ++k)
            if (!(signed_area(map[v[(k + n - 1) % n]], map[v[k]], map[v[(k + 1) % n]]) > 0)) return false;
    }
    return true;
}

}  // namespace

int reach_corners(const Surface& source, const TargetDomain& target, const std::vector<LoopOnto>& loops,
                  std::span<const Mark> marks, Eigen::VectorXcd& map) {
    struct Move {
        int vertex;
        Complex corner;
        std::vector<int> faces;
    };
    std::vector<Move> moves;
    std::vector<int> move_of(source.mesh.vertex_count(), -1);
    for (const LoopOnto& loop : loops) {
        const TargetCurve& curve = target.curve(loop.curve);
        const std::vector<int>& vertices = source.topology.boundary_loops[loop.loop];
        for (const double s : curve.corners(kSharp)) {
            std::size_t nearest = 0;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const double away = std::abs(std::remainder(loop.parameters[i] - s, curve.length()));
                if (away < least) least = away, nearest = i;
            }
            const int v = vertices[nearest];
            if (move_of[v] >= 0) continue;  // of two corners within an edge one is cut off
            move_of[v] = static_cast<int>(moves.size());
            moves.push_back({v, curve.point(s), {}});
        }
    }
    for (int f = 0; f < source.mesh.face_count(); ++f)
        for (const int v : source.mesh.faces[f])
            if (move_of[v] >= 0) moves[move_of[v]].faces.push_back(f);
    int reached = 0;
    for (const Move& move : moves) {
        const Complex before = map[move.vertex];
        const bool marked =
            std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.vertex == move.vertex; });
        if (!marked && before != move.corner) {
            map[move.vertex] = move.corner;
            if (!unfolded(source, move.faces, map)) map[move.vertex] = before;
        }
        reached += std::abs(map[move.vertex] - move.corner) <= 1e-12 * target.curve(0).diameter();
    }
    return reached;
}

}  // namespace beltrami
