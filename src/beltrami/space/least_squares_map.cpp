#include <beltrami/space/least_squares_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/element_system.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr int kExpectedFactorizations = 20;
constexpr double kShift = 1e-12;  // of the diagonal: rigid motions that only some constraint takes out

using Vector3 = Eigen::Vector3d;

/// c_k of the corners of a triangle.
std::array<Complex, 3> coefficients(const Operators& operators, int sample, Complex mu) {
    const auto g = operators.gradient(sample);
    std::array<Complex, 3> c;
    for (int k = 0; k < 3; ++k) c[k] = 0.5 * (g[k] - mu * std::conj(g[k]));
    return c;
}

Eigen::Matrix3d block(Complex cj, Complex ck, double weight, const Vector3& normal) {
    const Complex product = std::conj(cj) * ck;
    Eigen::Matrix3d cross;
    cross << 0, -normal[2], normal[1], normal[2], 0, -normal[0], -normal[1], normal[0], 0;
    return 2 * weight * (product.real() * Eigen::Matrix3d::Identity() + product.imag() * cross);
}

/// L X, L the cotangent Laplacian of the mesh itself: the gradient of its area.
Positions area_gradient(const Mesh& mesh) {
    const CornerElements own = corner_elements(mesh);
    const Operators& operators = own.operators;
    Positions gradient = Positions::Zero(mesh.vertex_count(), 3);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto v = operators.stencil(s);
        const auto g = operators.gradient(s);
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                gradient.row(v[j]) +=
                    operators.weights[s] * (std::conj(g[j]) * g[k]).real() * mesh.point(v[k]).transpose();
    }
    return gradient;
}

/// A vertex of every component, and the component of every vertex by it.
DisjointSets components(const Mesh& mesh) {
    DisjointSets sets(mesh.vertex_count());
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) sets.join(v, mesh.faces[f][0]);
    return sets;
}

}  // namespace

/// The unknowns: two or three directions at every free vertex.
struct LeastSquaresMap::System {
    int directions;
    std::vector<std::array<Vector3, 3>> frames;  // #V
    ElementSystem elements;

    static ElementSystem make(const Operators& operators, const std::vector<char>& fixed, int directions) {
        std::vector<int> place(fixed.size(), -1);
        int free = 0;
        for (std::size_t v = 0; v < fixed.size(); ++v)
            if (!fixed[v]) place[v] = free++;
        std::vector<int> offsets{0}, nodes;
        const bool pairs = directions == 2;
        for (int s = 0; s < operators.sample_count(); ++s) {
            for (const int v : operators.stencil(s)) {
                if (pairs) {
                    nodes.push_back(place[v]);
                } else {
                    for (int a = 0; a < 3; ++a) nodes.push_back(place[v] < 0 ? -1 : 3 * place[v] + a);
                }
            }
            offsets.push_back(static_cast<int>(nodes.size()));
        }
        return {std::move(offsets), std::move(nodes), pairs ? free : 3 * free, kExpectedFactorizations, pairs ? 2 : 1};
    }
};

LeastSquaresMap::LeastSquaresMap(const Mesh& source, const CornerElements& elements, Positions places,
                                 std::vector<char> fixed, Preserve preserve)
    : source_(source),
      elements_(elements),
      normals_(corner_normals(source)),
      places_(std::move(places)),
      fixed_(std::move(fixed)),
      preserve_(preserve) {
    for (int v = 0; v < source.vertex_count(); ++v)
        if (!fixed_[v]) places_.row(v) = source.point(v);
    for (const int v : unreferenced()) fixed_[v] = 1;
    if (preserve_ == Preserve::nothing) refuse_collapse();
    if (preserve_ == Preserve::area) hold_gauge();
    const int directions = preserve_ == Preserve::normals ? 2 : 3;
    system_ = std::make_unique<System>(System{directions, {}, System::make(elements.operators, fixed_, directions)});
    const Positions vertex_normal = vertex_normals(source);
    for (int v = 0; v < source.vertex_count(); ++v) {
        if (preserve_ != Preserve::normals) {
            system_->frames.push_back({Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()});
            continue;
        }
        const TangentFrame frame(Vector3(vertex_normal.row(v)));
        system_->frames.push_back({frame.first, frame.second, Vector3::Zero()});
    }
}

LeastSquaresMap::~LeastSquaresMap() = default;

std::vector<int> LeastSquaresMap::unreferenced() const {
    std::vector<char> seen(fixed_.size(), 0);
    for (const int v : source_.faces.vertices()) seen[v] = 1;
    std::vector<int> result;
    for (std::size_t v = 0; v < seen.size(); ++v)
        if (!seen[v]) result.push_back(static_cast<int>(v));
    return result;
}

/// Translations cost nothing and move no area: the first vertex of every component that has no fixed one stays.
void LeastSquaresMap::hold_gauge() {
    DisjointSets sets = components(source_);
    std::vector<char> held(fixed_.size(), 0);
    for (int v = 0; v < source_.vertex_count(); ++v)
        if (fixed_[v]) held[sets.find(v)] = 1;
    for (int v = 0; v < source_.vertex_count(); ++v)
        if (sets.find(v) == v && !held[v]) fixed_[v] = 1;
}

void LeastSquaresMap::refuse_collapse() const {
    DisjointSets sets = components(source_);
    std::vector<int> first(fixed_.size(), -1);
    std::vector<char> spread(fixed_.size(), 0);
    for (int v = 0; v < source_.vertex_count(); ++v) {
        if (!fixed_[v]) continue;
        int& one = first[sets.find(v)];
        if (one < 0) one = v;
        if (places_.row(one) != places_.row(v)) spread[sets.find(v)] = 1;
    }
    for (int v = 0; v < source_.vertex_count(); ++v)
        if (!spread[sets.find(v)])
            throw Error(Cause::bad_boundary,
                        "nothing keeps the surface from collapsing to a point: the component of vertex " +
                            std::to_string(v) + " has no two vertices with different prescribed places",
                        "prescribe places, or preserve normals or the area", {Things::vertices, {v}});
}

Positions LeastSquaresMap::solve(const Eigen::VectorXcd& mu) {
    const Operators& operators = elements_.operators;
    const int d = system_->directions;
    ElementSystem& system = system_->elements;
    system.clear();
    std::array<double, 45> lower;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto c = coefficients(operators, s, mu[s]);
        const auto v = operators.stencil(s);
        const Vector3 normal = normals_.row(s);
        std::array<std::array<Eigen::Matrix3d, 3>, 3> blocks;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k <= j; ++k) blocks[j][k] = block(c[j], c[k], operators.weights[s], normal);
        std::size_t entry = 0;
        for (int j = 0; j < 3; ++j)
            for (int a = 0; a < d; ++a) {
                const Vector3& row = system_->frames[v[j]][a];
                for (int k = 0; k <= j; ++k)
                    for (int b = 0; b < (k == j ? a + 1 : d); ++b)
                        lower[entry++] = row.dot(blocks[j][k] * system_->frames[v[k]][b]);
            }
        system.add(s, {lower.data(), entry});
    }
    if (preserve_ != Preserve::nothing) system.scale_diagonal(1 + kShift);
    system.factorize();

    const auto in_unknowns = [&](const Positions& field) {
        Eigen::VectorXd values(system.unknown_count());
        for (Eigen::Index v = 0, i = 0; v < field.rows(); ++v)
            if (!fixed_[v])
                for (int a = 0; a < d; ++a) values[i++] = system_->frames[v][a].dot(field.row(v));
        return values;
    };
    const Positions force = gradient(mu, places_);
    Eigen::VectorXd step;
    if (preserve_ == Preserve::area) {
        const Positions of_area = area_gradient(source_);
        Eigen::MatrixXd sides(system.unknown_count(), 2);
        sides.col(0) = -in_unknowns(force);
        sides.col(1) = in_unknowns(of_area);
        const Eigen::MatrixXd solutions = system.solve(sides);
        double prescribed = 0;  // by which the fixed vertices change the area
        for (Eigen::Index v = 0; v < places_.rows(); ++v)
            prescribed += of_area.row(v).dot(places_.row(v) - source_.point(v).transpose());
        step = solutions.col(0) - (sides.col(1).dot(solutions.col(0)) + prescribed) /
                                      sides.col(1).dot(solutions.col(1)) * solutions.col(1);
    } else {
        step = system.solve(-in_unknowns(force));
    }
    Positions map = places_;
    for (Eigen::Index v = 0, i = 0; v < map.rows(); ++v)
        if (!fixed_[v])
            for (int a = 0; a < d; ++a) map.row(v) += step[i++] * system_->frames[v][a].transpose();
    return map;
}

Positions LeastSquaresMap::gradient(const Eigen::VectorXcd& mu, const Positions& map) const {
    const Operators& operators = elements_.operators;
    Positions result = Positions::Zero(map.rows(), 3);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto c = coefficients(operators, s, mu[s]);
        const auto v = operators.stencil(s);
        const Vector3 normal = normals_.row(s);
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                result.row(v[j]) +=
                    (block(c[j], c[k], operators.weights[s], normal) * map.row(v[k]).transpose()).transpose();
    }
    return result;
}

namespace {

/// ∂ and ∂̄ of the tangential part and of the height of a map at a sample.
struct Split {
    Complex dz, dzbar, height_dz, height_dzbar;
};

Split split_at(const Operators& operators, int sample, const Vector3& normal, const Positions& map) {
    const TangentFrame frame(normal);
    const auto v = operators.stencil(sample);
    const auto g = operators.gradient(sample);
    Split split{};
    for (int k = 1; k < 3; ++k) {
        const Vector3 edge = map.row(v[k]) - map.row(v[0]);
        const Complex along(edge.dot(frame.first), edge.dot(frame.second));
        const double up = edge.dot(normal);
        split.dz += 0.5 * along * std::conj(g[k]);
        split.dzbar += 0.5 * along * g[k];
        split.height_dz += 0.5 * up * std::conj(g[k]);
        split.height_dzbar += 0.5 * up * g[k];
    }
    return split;
}

}  // namespace

double LeastSquaresMap::energy(const Eigen::VectorXcd& mu, const Positions& map) const {
    const Operators& operators = elements_.operators;
    return parallel_sum(operators.sample_count(), 0.0, [&](int first, int last) {
        double sum = 0;
        for (int s = first; s < last; ++s) {
            const Split at = split_at(operators, s, normals_.row(s), map);
            sum += 2 * operators.weights[s] *
                   (std::norm(at.dzbar - mu[s] * at.dz) + std::norm(at.height_dzbar - mu[s] * at.height_dz));
        }
        return sum;
    });
}

double LeastSquaresMap::best_step(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to,
                                  const Positions& map) const {
    const Operators& operators = elements_.operators;
    double along = 0, square = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const Split at = split_at(operators, s, normals_.row(s), map);
        const Complex change = to[s] - from[s], step = change * at.dz, height = change * at.height_dz;
        along += operators.weights[s] * (std::conj(step) * (at.dzbar - from[s] * at.dz) +
                                         std::conj(height) * (at.height_dzbar - from[s] * at.height_dz))
                                            .real();
        square += operators.weights[s] * (std::norm(step) + std::norm(height));
    }
    return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
}

int LeastSquaresMap::factorization_count() const {
    return system_->elements.factorization_count();
}

}  // namespace beltrami
