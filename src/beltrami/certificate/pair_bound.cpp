#include <beltrami/certificate/pair_bound.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/certificate/branched_cover.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/certificate/pair_iteration.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/meshing/polygon_fill.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

using detail::Laplacian;

/// A triangulation of the image has at least so many triangles.
constexpr int kLeastFill = 400;

/// ∫ u dv along the boundary: of every edge of the image (u_a + u_b)/2 (v_b − v_a), with v at the places that its ends
/// come from, signs included.
struct BoundaryPairing final : Pairing {
    struct End {
        int image, from, to;  ///< vertices
        double t;
        double image_sign, from_sign, to_sign;  ///< of their corners at the edge
    };
    std::vector<std::array<End, 2>> edges;
    int source_count, image_count;

    Eigen::VectorXd with_v(const Eigen::VectorXd& v) const override {
        Eigen::VectorXd result = Eigen::VectorXd::Zero(image_count);
        const auto at = [&](const End& end) {
            return (1 - end.t) * end.from_sign * v[end.from] + end.t * end.to_sign * v[end.to];
        };
        for (const auto& [a, b] : edges) {
            const double half = 0.5 * (at(b) - at(a));
            result[a.image] += a.image_sign * half;
            result[b.image] += b.image_sign * half;
        }
        return result;
    }
    Eigen::VectorXd with_u(const Eigen::VectorXd& u) const override {
        Eigen::VectorXd result = Eigen::VectorXd::Zero(source_count);
        const auto add = [&](const End& end, double value) {
            result[end.from] += (1 - end.t) * end.from_sign * value;
            result[end.to] += end.t * end.to_sign * value;
        };
        for (const auto& [a, b] : edges) {
            const double mean = 0.5 * (a.image_sign * u[a.image] + b.image_sign * u[b.image]);
            add(b, mean);
            add(a, -mean);
        }
        return result;
    }
    Eigen::VectorXd start() const override {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(image_count);
        double turn = 0;
        for (const auto& edge : edges) u[edge[0].image] = std::sin(turn += 2.399963);
        return u;
    }
};

BoundaryPairing pairing_of(const Surface& source, const BoundaryImage& image, const std::vector<signed char>& signs) {
    BoundaryPairing result;
    result.source_count = source.operators.vertex_count;
    result.image_count = image.operators.vertex_count;
    if (signs.empty()) {
        const auto end = [](const BoundaryImage::Place& p) {
            return BoundaryPairing::End{p.vertex, p.from, p.to, p.t, 1, 1, 1};
        };
        for (const auto& loop : image.loops)
            for (std::size_t i = 0; i < loop.size(); ++i)
                result.edges.push_back({end(loop[i]), end(loop[(i + 1) % loop.size()])});
        return result;
    }
    const FaceList& faces = source.mesh.faces;
    for (int c = 0; c < faces.corner_count(); ++c) {
        const auto& beside = source.topology.edge_faces[source.topology.corner_edges[c]];
        if (beside[0] >= 0 && beside[1] >= 0) continue;
        const int d = c - c % 3 + (c + 1) % 3, a = faces.vertices()[c], b = faces.vertices()[d];
        const double at_a = signs[c], at_b = signs[d];
        result.edges.push_back({{{a, a, a, 0, at_a, at_a, at_a}, {b, b, b, 0, at_b, at_b, at_b}}});
    }
    return result;
}

/// Functions of the vertices, up to sign or not.
class VertexEnergy final : public PairEnergy {
  public:
    /// @param held what has to be for the form to be definite
    VertexEnergy(const Operators& operators, const std::vector<int>& held, const std::vector<signed char>& signs)
        : form_(operators, held_flags(operators, held), 1, signs) {}
    Eigen::VectorXd solve(const Eigen::VectorXd& force) const override { return form_.solve(force); }
    Eigen::VectorXd apply(const Eigen::VectorXd& u) const override { return form_.apply(u); }
    double energy(const Eigen::VectorXd& u) const override { return form_.energy(u); }
    int factorization_count() const override { return form_.factorization_count(); }

  private:
    static std::vector<char> held_flags(const Operators& operators, const std::vector<int>& held) {
        std::vector<char> flags(static_cast<std::size_t>(operators.vertex_count), 0);
        for (const int v : held) flags[v] = 1;
        return flags;
    }
    Laplacian form_;
};

PairBound pair_of_vertex_functions(const Surface& source, const BoundaryImage& image,
                                   const std::vector<int>& held_in_source, const std::vector<int>& held_in_image,
                                   const std::vector<signed char>& signs, const PairBoundOptions& options) {
    return best_pair(VertexEnergy(source.operators, held_in_source, signs),
                     VertexEnergy(image.operators, held_in_image, signs), pairing_of(source, image, signs), options);
}

/// Midpoints on all edges.
void subdivide(Mesh& mesh, std::vector<BoundaryImage::Place>& loop) {
    const Topology before = topology(mesh);
    const int vertices = mesh.vertex_count();
    mesh = midpoint_subdivide(mesh).mesh;
    std::vector<BoundaryImage::Place> finer;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const BoundaryImage::Place &a = loop[i], &b = loop[(i + 1) % loop.size()];
        const std::array<int, 2> ends{std::min(a.vertex, b.vertex), std::max(a.vertex, b.vertex)};
        const auto edge = std::lower_bound(before.edges.begin(), before.edges.end(), ends) - before.edges.begin();
        const double end = b.from == a.from ? b.t : 1;  // the next place of the edge, or its end
        finer.push_back(a);
        finer.push_back({vertices + static_cast<int>(edge), a.from, a.to, 0.5 * (a.t + end)});
    }
    loop = std::move(finer);
}

}  // namespace

std::optional<BoundaryImage> image_under(const Surface& source, const Eigen::VectorXcd& map) {
    for (const Complex mu : beltrami_coefficient(source.operators, map))
        if (!(std::norm(mu) < 1)) return std::nullopt;
    BoundaryImage image;
    const Mesh& mesh = source.mesh;
    Positions corners(mesh.faces.corner_count(), 2);
    for (int c = 0; c < mesh.faces.corner_count(); ++c) {
        const Complex z = map[mesh.faces.vertices()[c]];
        corners.row(c) << z.real(), z.imag();
    }
    try {
        image.operators = operators_from_corners(mesh, corners);
    } catch (const Error&) {  // areas that rounding has taken
        return std::nullopt;
    }
    for (const auto& loop : source.topology.boundary_loops) {
        image.loops.emplace_back();
        for (const int v : loop) image.loops.back().push_back({v, v, v, 0});
    }
    image.same_faces = true;
    return image;
}

std::optional<BoundaryImage> filled_image(const Surface& source, const Eigen::VectorXcd& map) {
    const auto& loops = source.topology.boundary_loops;
    if (loops.size() != 1) return std::nullopt;
    std::vector<Complex> corners;
    for (const int v : loops[0]) corners.push_back(map[v]);
    double area = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        area += std::imag(std::conj(corners[i]) * corners[(i + 1) % corners.size()]);
    if (!(area > 0)) return std::nullopt;
    BoundaryImage image;
    try {
        const PolygonFill fill = fill_polygon(corners);
        Mesh mesh;
        const auto n = static_cast<Eigen::Index>(corners.size() + fill.added.size());
        mesh.positions.resize(n, 2);
        for (Eigen::Index v = 0; v < n; ++v) {
            const auto at = static_cast<std::size_t>(v);
            const Complex z = at < corners.size() ? corners[at] : fill.added[at - corners.size()];
            mesh.positions.row(v) << z.real(), z.imag();
        }
        for (const auto& [a, b, c] : fill.triangles) mesh.faces.add({a, b, c});
        image.loops.emplace_back();
        for (std::size_t i = 0; i < corners.size(); ++i)
            image.loops[0].push_back({static_cast<int>(i), loops[0][i], loops[0][(i + 1) % corners.size()], 0});
        const int enough = std::max(kLeastFill, source.mesh.face_count() / 4);
        while (mesh.face_count() < enough) subdivide(mesh, image.loops[0]);
        image.operators = operators(mesh);
    } catch (const Error&) {  // not simple, or finer than numbers allow
        return std::nullopt;
    }
    return image;
}

double quadrilateral_bound(const Surface& source, const BoundaryImage& image, const std::array<int, 4>& positions) {
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    std::vector<int> image_loop;
    std::array<int, 4> corners{};
    for (const BoundaryImage::Place& place : image.loops[0]) {
        for (int i = 0; i < 4; ++i)
            if (place.t == 0 && place.from == loop[positions[i]]) corners[i] = static_cast<int>(image_loop.size());
        image_loop.push_back(place.vertex);
    }
    // The image's loop begins where the source's does.
    return modulus_ratio(quadrilateral_modulus(source.operators, sides_between(loop, positions)),
                         quadrilateral_modulus(image.operators, sides_between(image_loop, corners)));
}

PairBound pair_bound(const Surface& source, const BoundaryImage& image, const std::vector<int>& branches,
                     const PairBoundOptions& options) {
    if (branches.empty())
        return pair_of_vertex_functions(source, image, {source.operators.vertices.front()},
                                        {image.operators.vertices.front()}, {}, options);
    return pair_of_vertex_functions(source, image, branches, branches, branched_signs(source, branches), options);
}

PairBound pair_bound_up_to_sign(const Surface& source, const BoundaryImage& image,
                                const std::vector<signed char>& signs, const PairBoundOptions& options) {
    return pair_of_vertex_functions(source, image, {}, {}, signs, options);
}

}  // namespace beltrami
