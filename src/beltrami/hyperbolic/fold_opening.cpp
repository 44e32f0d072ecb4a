#include <beltrami/hyperbolic/fold_opening.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include <beltrami/hyperbolic/face_chart.h>
#include <beltrami/plane/klein.h>

namespace beltrami {

namespace {

constexpr int kRounds = 40;
constexpr int kRings = 2;               // around flipped faces, whose vertices are moved where theirs cannot be
constexpr int kParts = 16;              // of the way, that are tried
constexpr std::size_t kMostFaces = 24;  // around a vertex that is moved
constexpr double kGain = 1e-6;          // of the badness of the worst face around a vertex
constexpr double kFolded = 1e3;         // badness of a face with no area; of a flipped one more

/// The edges around a vertex, seen from its image at 0 in Klein's model: a face lies on their left.
using Link = std::vector<std::array<Complex, 2>>;

Link link_of(const Surface& source, const EquivariantMap& map, const std::vector<int>& corners) {
    Link link;
    link.reserve(corners.size());
    for (const int corner : corners) {
        const int first = corner - corner % 3;
        const DiskIsometry there = step_at_corner(source, map, corner),
                           back = step_at_corner(source, map, first + (corner + 2) % 3);
        link.push_back({to_klein(there.place()), to_klein(back.inverse().place())});
    }
    return link;
}

double distance_from_line(const std::array<Complex, 2>& edge, Complex place) {
    const Complex way = edge[1] - edge[0];
    return std::imag(std::conj(way) * (place - edge[0])) / std::max(std::abs(way), 1e-300);
}

/// Where the least distance from the lines is largest: of all places where three are equal, or, on the real axis, two.
Complex farthest_from_lines(const Link& link, bool on_axis) {
    const std::size_t n = link.size();
    // distance = h + g · place, of every line
    std::vector<Eigen::Vector3d> lines;
    lines.reserve(n);
    for (const std::array<Complex, 2>& edge : link) {
        const double at_zero = distance_from_line(edge, 0);
        lines.emplace_back(distance_from_line(edge, 1) - at_zero, distance_from_line(edge, Complex(0, 1)) - at_zero,
                           at_zero);
    }
    const auto least_at = [&](const Complex place) {
        double least = std::numeric_limits<double>::infinity();
        for (const Eigen::Vector3d& line : lines)
            least = std::min(least, line[0] * place.real() + line[1] * place.imag() + line[2]);
        return least;
    };
    Complex best = 0;
    double most = least_at(0);
    const auto look_at = [&](const Complex place) {
        if (!(std::abs(place) < 1)) return;
        const double least = least_at(place);
        if (!(least > most)) return;
        most = least;
        best = place;
    };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            if (on_axis) {
                look_at((lines[j][2] - lines[i][2]) / (lines[i][0] - lines[j][0]));
                continue;
            }
            for (std::size_t k = j + 1; k < n; ++k) {
                Eigen::Matrix2d equal;
                equal.row(0) = (lines[i] - lines[j]).head<2>();
                equal.row(1) = (lines[i] - lines[k]).head<2>();
                const Eigen::Vector2d place =
                    equal.inverse() * Eigen::Vector2d(lines[j][2] - lines[i][2], lines[k][2] - lines[i][2]);
                look_at({place[0], place[1]});
            }
        }
    return best;
}

/// 1/(1 − |μ|²) of a face, and far more where it is flipped.
double badness(const Surface& source, int face, const std::array<Complex, 3>& places) {
    Complex dz = 0, dzbar = 0;
    const auto gradients = source.operators.gradient(face);
    for (std::size_t k = 0; k < 3; ++k) {
        dz += 0.5 * places[k] * std::conj(gradients[k]);
        dzbar += 0.5 * places[k] * gradients[k];
    }
    const double square = std::norm(dzbar) / std::max(std::norm(dz), 1e-300);
    return square < 1 - 1 / kFolded ? 1 / (1 - square) : kFolded * (2 - 1 / std::max(square, 1.0));
}

/// The worst face around a vertex whose image is moved by ξ in its own frame.
double worst_around(const Surface& source, const EquivariantMap& map, const std::vector<int>& corners, Complex xi) {
    const DiskIsometry move = DiskIsometry::translation(xi), back = DiskIsometry::translation(-xi);
    double worst = 0;
    for (const int corner : corners) {
        const int first = corner - corner % 3, at = corner % 3;
        // The face from its first corner on, as it comes to be.
        const auto step_at = [&](int k) {
            DiskIsometry step = step_at_corner(source, map, first + k);
            if (k == at) step = back * step;
            if ((k + 1) % 3 == at) step = step * move;
            return step;
        };
        const FaceChart chart(step_at(0), step_at(2));
        worst = std::max(worst, badness(source, first / 3, chart.places()));
    }
    return worst;
}

void move_by(const Surface& source, EquivariantMap& map, int vertex, const std::vector<int>& corners, Complex xi) {
    const DiskIsometry move = DiskIsometry::translation(xi), back = DiskIsometry::translation(-xi);
    std::vector<int> edges;
    edges.reserve(2 * corners.size());
    for (const int corner : corners)
        for (const int c : {corner, corner - corner % 3 + (corner + 2) % 3})
            edges.push_back(source.topology.corner_edges[static_cast<std::size_t>(c)]);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const int e : edges) {
        DiskIsometry& step = map.steps[static_cast<std::size_t>(e)];
        const bool begins = source.topology.edges[static_cast<std::size_t>(e)][0] == vertex;
        step = (begins ? back * step : step * move).normalized();
    }
    DiskIsometry& frame = map.frames[static_cast<std::size_t>(vertex)];
    frame = (frame * move).normalized();
}

std::vector<int> flipped_faces(const Surface& source, const EquivariantMap& map) {
    std::vector<int> result;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const FaceChart chart(step_at_corner(source, map, 3 * f), step_at_corner(source, map, 3 * f + 2));
        if (!(badness(source, f, chart.places()) < kFolded)) result.push_back(f);
    }
    return result;
}

/// Vertices of faces, and of so many rings of faces around these, ascending.
std::vector<int> vertices_around(const Surface& source, const std::vector<int>& faces, int rings) {
    std::vector<char> chosen(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int f : faces)
        for (const int v : source.mesh.faces[f]) chosen[static_cast<std::size_t>(v)] = 1;
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<char> wider = chosen;
        for (const auto& [a, b] : source.topology.edges)
            if (chosen[static_cast<std::size_t>(a)] || chosen[static_cast<std::size_t>(b)])
                wider[static_cast<std::size_t>(a)] = wider[static_cast<std::size_t>(b)] = 1;
        chosen = std::move(wider);
    }
    std::vector<int> result;
    for (std::size_t v = 0; v < chosen.size(); ++v)
        if (chosen[v]) result.push_back(static_cast<int>(v));
    return result;
}

}  // namespace

int open_folds(const Surface& source, EquivariantMap& map) {
    if (source.operators.sample_count() != source.mesh.face_count()) return 0;
    std::vector<int> flipped = flipped_faces(source, map);
    if (flipped.empty()) return 0;
    const FaceList& faces = source.mesh.faces;
    std::vector<std::vector<int>> corners_at(static_cast<std::size_t>(source.mesh.vertex_count()));
    for (int c = 0; c < faces.corner_count(); ++c)
        corners_at[static_cast<std::size_t>(faces.vertices()[c])].push_back(c);
    std::vector<char> moved(corners_at.size(), 0);
    const auto improve = [&](int v) {
        const std::vector<int>& corners = corners_at[static_cast<std::size_t>(v)];
        if (corners.size() > kMostFaces) return false;
        const bool on_axis = source.topology.on_boundary[static_cast<std::size_t>(v)] != 0;
        const Complex place = from_klein(farthest_from_lines(link_of(source, map, corners), on_axis));
        const double size = std::abs(place);
        if (!(size > 0) || !(size < 1)) return false;
        const Complex way = 2 * std::atanh(size) / size * place;
        double least = (1 - kGain) * worst_around(source, map, corners, 0);
        Complex best = 0;
        for (int part = 1; part <= kParts; ++part) {
            const Complex xi = static_cast<double>(part) / kParts * way;
            const double worst = worst_around(source, map, corners, xi);
            if (!(worst < least)) continue;
            least = worst;
            best = xi;
        }
        if (best == 0.0) return false;
        move_by(source, map, v, corners, best);
        moved[static_cast<std::size_t>(v)] = 1;
        return true;
    };
    for (int round = 0, rings = 0; round < kRounds && !flipped.empty() && rings <= kRings; ++round) {
        bool any = false;
        for (const int v : vertices_around(source, flipped, rings)) any = improve(v) || any;
        rings = any ? 0 : rings + 1;
        flipped = flipped_faces(source, map);
    }
    return static_cast<int>(std::count(moved.begin(), moved.end(), 1));
}

}  // namespace beltrami
