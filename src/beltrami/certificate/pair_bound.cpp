#include <beltrami/certificate/pair_bound.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/certificate/branched_cover.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/linear/decomposition.h>
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
struct BoundaryPairing {
    struct End {
        int image, from, to;  ///< vertices
        double t;
        double image_sign, from_sign, to_sign;  ///< of their corners at the edge
    };
    std::vector<std::array<End, 2>> edges;
    int source_count, image_count;

    /// W v: what u is paired with.
    Eigen::VectorXd with_v(const Eigen::VectorXd& v) const {
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
    /// Wᵀ u.
    Eigen::VectorXd with_u(const Eigen::VectorXd& u) const {
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

/// What has to be held for a Dirichlet form to be definite: a vertex, or all where the functions branch.
std::vector<char> held_vertices_of(const Operators& operators, const std::vector<int>& branches) {
    std::vector<char> held(static_cast<std::size_t>(operators.vertex_count), 0);
    for (const int v : branches) held[v] = 1;
    if (branches.empty()) held[operators.vertices.front()] = 1;
    return held;
}

/// Lanczos' iteration for the largest eigenvalue of L_S⁻¹ Wᵀ L_T⁻¹ W, in the energy product of L_S.
class Lanczos {
  public:
    Lanczos(const Laplacian& source, const Laplacian& image, const BoundaryPairing& pairing)
        : source_(source), image_(image), pairing_(pairing) {}

    /// The Ritz vector v after as many steps as needed.
    Eigen::VectorXd run(const PairBoundOptions& options) {
        start();
        while (static_cast<int>(basis_.size()) < options.most_steps && step())
            if (const std::size_t n = values_.size();
                n > 4 && values_[n - 1] <= (1 + options.tolerance) * values_[n - 4])
                break;
        return ritz();
    }
    int steps() const { return static_cast<int>(values_.size()); }

  private:
    /// v that pairs with u = a function of the boundary that no symmetry makes orthogonal to the wanted one.
    void start() {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(pairing_.image_count);
        double turn = 0;
        for (const auto& edge : pairing_.edges) u[edge[0].image] = std::sin(turn += 2.399963);
        // Two rounds of the power iteration smooth it.
        Eigen::VectorXd v =
            source_.solve(pairing_.with_u(image_.solve(pairing_.with_v(source_.solve(pairing_.with_u(u))))));
        push(v);
    }
    void push(const Eigen::VectorXd& v) {
        Eigen::VectorXd applied = source_.apply(v);
        const double size = std::sqrt(std::max(0.0, v.dot(applied)));
        if (!(size > 0) || !std::isfinite(size)) return;
        basis_.push_back(v / size);
        applied_.push_back(applied / size);
    }
    /// @return false where the space is exhausted
    bool step() {
        const std::size_t n = values_.size();
        if (n >= basis_.size()) return false;
        Eigen::VectorXd next = source_.solve(pairing_.with_u(image_.solve(pairing_.with_v(basis_[n]))));
        double diagonal = 0;
        for (int pass = 0; pass < 2; ++pass)  // twice: orthogonal to rounding
            for (std::size_t i = basis_.size(); i-- > 0;) {
                const double part = next.dot(applied_[i]);
                if (i == n) diagonal += part;
                next -= part * basis_[i];
            }
        diagonal_.push_back(diagonal);
        Eigen::VectorXd applied = source_.apply(next);
        const double size = std::sqrt(std::max(0.0, next.dot(applied)));
        beside_.push_back(size);
        values_.push_back(eigen().values[static_cast<Eigen::Index>(n)]);
        if (!(size > 1e-12 * values_[0])) return false;
        basis_.push_back(next / size);
        applied_.push_back(applied / size);
        return true;
    }
    SymmetricEigen eigen() const {
        const auto n = static_cast<Eigen::Index>(diagonal_.size());
        Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            T(i, i) = diagonal_[i];
            if (i > 0) T(i, i - 1) = beside_[i - 1];
        }
        return symmetric_eigen(T);
    }
    Eigen::VectorXd ritz() const {
        Eigen::VectorXd v = Eigen::VectorXd::Zero(pairing_.source_count);
        if (diagonal_.empty()) return v;
        const SymmetricEigen all = eigen();
        const Eigen::Index n = all.values.size();
        for (Eigen::Index i = 0; i < n; ++i) v += all.vectors(i, n - 1) * basis_[i];
        return v;
    }

    const Laplacian &source_, &image_;
    const BoundaryPairing& pairing_;
    std::vector<Eigen::VectorXd> basis_, applied_;
    std::vector<double> diagonal_, beside_, values_;
};

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
    std::vector<signed char> signs;
    if (!branches.empty()) signs = branched_signs(source, branches);
    const Laplacian of_source(source.operators, held_vertices_of(source.operators, branches), 1, signs),
        of_image(image.operators, held_vertices_of(image.operators, branches), 1, signs);
    const BoundaryPairing pairing = pairing_of(source, image, signs);
    PairBound result;
    result.factorizations = of_source.factorization_count() + of_image.factorization_count();
    Lanczos lanczos(of_source, of_image, pairing);
    result.v = lanczos.run(options);
    result.steps = lanczos.steps();
    const Eigen::VectorXd paired = pairing.with_v(result.v);
    result.u = of_image.solve(paired);
    const double pairs = result.u.dot(paired), energies = of_image.energy(result.u) * of_source.energy(result.v);
    if (energies > 0 && std::isfinite(energies)) result.K = std::max(1.0, pairs * pairs / energies);
    return result;
}

}  // namespace beltrami
