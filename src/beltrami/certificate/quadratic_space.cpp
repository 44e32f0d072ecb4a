#include <beltrami/certificate/quadratic_space.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Bernstein bounds are subdivided so often where they exceed what is attained, and where they prove nothing.
constexpr int kSpaceDepth = 4, kSpaceProofDepth = 9;
/// A bound may be larger by this part than what is attained.
constexpr double kCloseEnough = 1e-6;
/// Rays of a power element at which it is sampled.
constexpr int kRays = 7;
/// Angles that sum to 2π to within this are flat.
constexpr double kFlat = 1e-7;

/// Of a face seen from corner c: the vectors to the next two corners.
std::array<Complex, 2> sides_at(const Operators& operators, int face, int c) {
    const auto g = operators.gradient(face);
    const Complex factor(0, -2 * operators.weights[face]);
    const Complex to_next = factor * g[(c + 2) % 3], opposite = factor * g[c];
    return {to_next, to_next + opposite};
}

/// max over the Bernstein coefficients of |b|² over those of |a|²; infinite if one of the latter is not positive.
struct Triangle {
    std::array<Complex, 3> a, b;  ///< linear between corners

    double bound() const {
        double bound = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) {
                const double below = std::real(a[i] * std::conj(a[j]));
                if (!(below > 0)) return kInfinity;
                bound = std::max(bound, std::real(b[i] * std::conj(b[j])) / below);
            }
        return bound;
    }
    double attained() const {
        double value = 0;
        for (int i = 0; i < 3; ++i) value = std::max(value, std::norm(b[i]) / std::norm(a[i]));
        return value;
    }
    std::array<Triangle, 4> parts() const {
        Triangle m;
        for (int i = 0; i < 3; ++i) {
            m.a[i] = 0.5 * (a[(i + 1) % 3] + a[(i + 2) % 3]);
            m.b[i] = 0.5 * (b[(i + 1) % 3] + b[(i + 2) % 3]);
        }
        std::array<Triangle, 4> result;
        for (int i = 0; i < 3; ++i) {
            result[i] = m;
            result[i].a[i] = a[i];
            result[i].b[i] = b[i];
        }
        result[3] = m;
        return result;
    }
};

/// The same along the rays of a power element, of degree 3.
struct Rays {
    std::array<Complex, 4> a, b;  ///< Bernstein coefficients

    double bound() const {
        constexpr std::array<double, 4> three{1, 3, 3, 1};
        std::array<double, 7> above{}, below{};
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const double weight = three[i] * three[j];
                above[i + j] += weight * std::real(b[i] * std::conj(b[j]));
                below[i + j] += weight * std::real(a[i] * std::conj(a[j]));
            }
        double bound = 0;
        for (int i = 0; i < 7; ++i) {
            if (!(below[i] > 0)) return kInfinity;
            bound = std::max(bound, above[i] / below[i]);
        }
        return bound;
    }
    double attained() const { return std::max(std::norm(b[0]) / std::norm(a[0]), std::norm(b[3]) / std::norm(a[3])); }
    std::array<Rays, 2> parts() const {
        std::array<Rays, 2> result;
        const auto cut = [](std::array<Complex, 4> c, std::array<Complex, 4>& left, std::array<Complex, 4>& right) {
            for (int n = 3; n >= 0; --n) {  // de Casteljau
                left[3 - n] = c[0];
                right[n] = c[n];
                for (int i = 0; i < n; ++i) c[i] = 0.5 * (c[i] + c[i + 1]);
            }
        };
        cut(a, result[0].a, result[1].a);
        cut(b, result[0].b, result[1].b);
        return result;
    }
};

/// A bound of |μ|², refined down to @p enough.
template <class Element>
double refined_bound(const Element& element, double enough, int depth) {
    const double bound = element.bound();
    if (bound <= enough || depth >= (std::isfinite(bound) ? kSpaceDepth : kSpaceProofDepth)) return bound;
    double result = 0;
    for (const Element& part : element.parts()) {
        result = std::max(result, refined_bound(part, enough, depth + 1));
        if (std::isinf(result)) break;
    }
    return std::min(bound, result);
}

}  // namespace

std::vector<ConePoint> cone_points(const Surface& source) {
    std::vector<double> angles(static_cast<std::size_t>(source.mesh.vertex_count()), 0.0);
    for (int f = 0; f < source.mesh.face_count(); ++f)
        for (int c = 0; c < 3; ++c) {
            const auto [a, b] = sides_at(source.operators, f, c);
            angles[source.mesh.faces[f][c]] += std::arg(b * std::conj(a));
        }
    std::vector<ConePoint> cones;
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        const double whole = 2 * std::numbers::pi;
        if (source.topology.on_boundary[v] || angles[v] == 0 || std::abs(angles[v] - whole) < kFlat) continue;
        cones.push_back({v, std::max(angles[v] / whole, whole / angles[v])});
    }
    return cones;
}

QuadraticSpace::QuadraticSpace(const Surface& source, const std::vector<int>& cones)
    : source_(source),
      power_(static_cast<std::size_t>(source.mesh.face_count()), 0.0),
      apex_(static_cast<std::size_t>(source.mesh.face_count()), -1) {
    const Topology& topology = source.topology;
    const FaceList& faces = source.mesh.faces;
    const int vertices = source.mesh.vertex_count();
    std::vector<double> angle(static_cast<std::size_t>(vertices), 0.0);
    std::vector<char> is_cone(static_cast<std::size_t>(vertices), 0);
    for (const int v : cones) is_cone[v] = 1;
    for (int f = 0; f < faces.size(); ++f)
        for (int c = 0; c < 3; ++c) {
            if (!is_cone[faces[f][c]]) continue;
            apex_[f] = c;
            const auto [a, b] = sides_at(source.operators, f, c);
            angle[faces[f][c]] += std::arg(b * std::conj(a));
        }
    samples_.vertex_count = vertices + topology.edge_count();
    samples_.face_count = faces.size();
    idle_.assign(static_cast<std::size_t>(samples_.vertex_count), 0);
    for (int e = 0; e < topology.edge_count(); ++e)
        for (const int v : topology.edges[e])
            if (is_cone[v]) idle_[vertices + e] = 1;

    for (int f = 0; f < faces.size(); ++f) {
        first_.push_back(samples_.sample_count());
        const auto v = faces[f];
        const auto g = source.operators.gradient(f);
        const auto edge = [&](int c) { return vertices + topology.corner_edges[3 * f + c]; };
        const auto close = [&](int samples) {
            samples_.offsets.push_back(static_cast<int>(samples_.vertices.size()));
            samples_.weights.push_back(source.operators.weights[f] / samples);
            samples_.faces.push_back(f);
        };
        if (apex_[f] < 0) {
            for (int q = 0; q < 6; ++q) {
                std::array<double, 3> at{0, 0, 0};
                if (q < 3)
                    at[q] = 1;
                else
                    at[q - 3] = at[(q - 2) % 3] = 0.5;
                for (int j = 0; j < 3; ++j) {
                    samples_.vertices.push_back(v[j]);
                    samples_.gradients.push_back((4 * at[j] - 1) * g[j]);
                }
                for (int j = 0; j < 3; ++j) {
                    const int next = (j + 1) % 3;
                    samples_.vertices.push_back(edge(j));
                    samples_.gradients.push_back(4.0 * (at[j] * g[next] + at[next] * g[j]));
                }
                close(6);
            }
            continue;
        }
        const int c = apex_[f], ia = (c + 1) % 3, ib = (c + 2) % 3;
        const auto [to_a, to_b] = sides_at(source.operators, f, c);
        const double power = power_[f] = 2 * std::numbers::pi / angle[v[c]];
        const std::array<int, 4> nodes{v[ia], edge(ia), v[ib], v[c]};
        for (int q = 0; q < kRays; ++q) {
            const double s = static_cast<double>(q) / (kRays - 1);
            const Complex w = (1 - s) * to_a + s * to_b, L = (to_b - to_a) / w;
            const std::array<double, 4> N{(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1), -1},
                slope{4 * s - 3, 4 - 8 * s, 4 * s - 1, 0};
            const Complex along = w / std::norm(w);
            for (int j = 0; j < 4; ++j) {
                samples_.vertices.push_back(nodes[j]);
                samples_.gradients.push_back(along *
                                             Complex(power * N[j], (slope[j] - power * N[j] * L.real()) / L.imag()));
            }
            close(kRays);
        }
    }
    first_.push_back(samples_.sample_count());
}

std::vector<double> QuadraticSpace::bounds(const QuadraticMap& map) const {
    const int count = source_.mesh.face_count();
    std::vector<double> square(static_cast<std::size_t>(count)), attained(square.size());
    const auto of_triangle = [&](int f) {
        Triangle t;
        for (int i = 0; i < 3; ++i) {
            const auto [dz, dzbar] = samples_.derivatives(first_[f] + i, map);
            t.a[i] = dz;
            t.b[i] = dzbar;
        }
        return t;
    };
    // With |w|² and 2A = Im(conj(w) w') the numbers γG ± iG′ are polynomials: G of degree 2, and
    // 2A G′ = G_s |w|² − γ G Re(conj(w) w').
    const auto of_rays = [&](int f) {
        const int c = apex_[f], vertices = source_.mesh.vertex_count();
        const auto v = source_.mesh.faces[f];
        const auto [to_a, to_b] = sides_at(source_.operators, f, c);
        const Complex across = to_b - to_a, apex = map[v[c]];
        const double twice = std::imag(std::conj(to_a) * across), power = power_[f];
        const Complex p0 = map[v[(c + 1) % 3]] - apex, p2 = map[v[(c + 2) % 3]] - apex,
                      middle = map[vertices + source_.topology.corner_edges[3 * f + (c + 1) % 3]] - apex,
                      p1 = 2.0 * middle - 0.5 * (p0 + p2);
        const std::array<Complex, 3> G{p0, p1, p2};                            // Bernstein, degree 2
        const std::array<Complex, 2> slope{2.0 * (p1 - p0), 2.0 * (p2 - p1)};  // degree 1
        const std::array<double, 3> size{std::norm(to_a), std::real(std::conj(to_a) * to_b), std::norm(to_b)};
        const std::array<double, 2> dot{std::real(std::conj(to_a) * across), std::real(std::conj(to_b) * across)};
        // Products in Bernstein form, to degree 3.
        std::array<Complex, 4> product{}, raised{};
        constexpr std::array<double, 3> two{1, 2, 1};
        constexpr std::array<double, 4> three{1, 3, 3, 1};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 2; ++j) {
                product[i + j] += two[i] * (slope[j] * size[i] - power * G[i] * dot[j]) / three[i + j];
                raised[i + j] += two[i] * G[i] / three[i + j];
            }
        Rays rays;
        for (int i = 0; i < 4; ++i) {
            const Complex turned = Complex(0, 1) * product[i] / twice;
            rays.a[i] = power * raised[i] - turned;
            rays.b[i] = power * raised[i] + turned;
        }
        return rays;
    };
    parallel_for(0, count, [&](int first, int last) {
        for (int f = first; f < last; ++f) {
            if (apex_[f] >= 0) {
                const Rays rays = of_rays(f);
                square[f] = rays.bound();
                attained[f] = rays.attained();
            } else {
                const Triangle t = of_triangle(f);
                square[f] = t.bound();
                attained[f] = t.attained();
            }
        }
    });
    double largest = 0;
    for (const double value : attained)
        if (value < 1) largest = std::max(largest, value);
    const double enough = largest * (1 + kCloseEnough);
    parallel_for(
        0, count,
        [&](int first, int last) {
            for (int f = first; f < last; ++f) {
                if (!(square[f] > enough)) continue;
                square[f] =
                    apex_[f] >= 0 ? refined_bound(of_rays(f), enough, 0) : refined_bound(of_triangle(f), enough, 0);
            }
        },
        256);
    for (double& value : square) value = std::isnan(value) ? kInfinity : std::sqrt(value);
    return square;
}

Complex QuadraticSpace::value(const QuadraticMap& map, int face, const std::array<double, 3>& place) const {
    const auto v = source_.mesh.faces[face];
    const int vertices = source_.mesh.vertex_count();
    const auto edge = [&](int c) { return map[vertices + source_.topology.corner_edges[3 * face + c]]; };
    if (apex_[face] < 0) {
        Complex sum = 0;
        for (int j = 0; j < 3; ++j) {
            sum += place[j] * (2 * place[j] - 1) * map[v[j]];
            sum += 4 * place[j] * place[(j + 1) % 3] * edge(j);
        }
        return sum;
    }
    const int c = apex_[face], ia = (c + 1) % 3, ib = (c + 2) % 3;
    const double far = place[ia] + place[ib];  // ρ
    if (!(far > 0)) return map[v[c]];
    const double s = place[ib] / far;
    const Complex on_edge =
        (1 - s) * (1 - 2 * s) * map[v[ia]] + 4 * s * (1 - s) * edge(ia) + s * (2 * s - 1) * map[v[ib]];
    return map[v[c]] + std::pow(far, power_[face]) * (on_edge - map[v[c]]);
}

}  // namespace beltrami
