#include <beltrami/solve/beltrami_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/base/unless_stopped.h>
#include <beltrami/linear/element_system.h>

namespace beltrami {

namespace {

constexpr int kMostUnknowns = 8;  // of one sample: a quad with four free corners

/// Conjugate gradients with an old factor: best accuracy, and how many steps are cheaper than a new factorisation.
constexpr double kNearTolerance = 1e-11;
constexpr int kMostNearSteps = 7;
/// Unknowns from which on a factorisation takes longer than whoever wants it stopped should wait.
constexpr int kLarge = 10000;
/// Samples whose matrices are found before they are added.
constexpr int kSamplesAtOnce = 8192;
/// Right-hand sides that are assembled in one pass over the samples.
constexpr int kOffsetsAtOnce = 6;

}  // namespace

struct BeltramiSolver::Implementation {
    const Operators& operators;
    std::vector<Freedom> freedom;
    bool decoupled;
    int most_entries = 0;            // of an element's lower triangle
    std::vector<int> first_unknown;  // #V, −1 if fixed; a free vertex of the coupled system has this one and the next
    std::vector<int> owner;          // unknown → vertex
    std::shared_ptr<ElementSystem> system;
    std::shared_future<void> left;  ///< a factorisation that was not waited for
    Eigen::VectorXcd nu, directions;

    Implementation(const Surface& source, std::vector<Freedom> f, int expected_factorizations)
        : operators(source.operators), freedom(std::move(f)) {
        decoupled = true;
        for (int v = 0; v < operators.vertex_count; ++v)
            if (freedom[v] == Freedom::sliding || (source.topology.on_boundary[v] && freedom[v] != Freedom::fixed))
                decoupled = false;

        first_unknown.assign(operators.vertex_count, -1);
        for (int v = 0; v < operators.vertex_count; ++v) {
            if (freedom[v] == Freedom::fixed) continue;
            first_unknown[v] = static_cast<int>(owner.size());
            owner.push_back(v);
            if (!decoupled && freedom[v] == Freedom::free) owner.push_back(v);
        }
        std::vector<int> offsets{0}, unknowns;
        offsets.reserve(operators.offsets.size());
        unknowns.reserve(operators.vertices.size() * (decoupled ? 1 : 2));
        for (int s = 0; s < operators.sample_count(); ++s) {
            for (const int v : operators.stencil(s)) {
                unknowns.push_back(first_unknown[v]);
                if (!decoupled && freedom[v] == Freedom::free) unknowns.push_back(first_unknown[v] + 1);
            }
            const int corners = static_cast<int>(unknowns.size()) - offsets.back();
            most_entries = std::max(most_entries, corners * (corners + 1) / 2);
            offsets.push_back(static_cast<int>(unknowns.size()));
        }
        const int count = static_cast<int>(owner.size());
        const auto made = std::make_shared<std::shared_ptr<ElementSystem>>();
        unless_stopped([=, o = std::move(offsets), u = std::move(unknowns)]() mutable {
            *made = std::make_shared<ElementSystem>(std::move(o), std::move(u), count, expected_factorizations);
        });
        system = *made;
    }

    /// D of every unknown of an element, in the order of system->nodes; returns their number.
    int element(int sample, std::array<Complex, kMostUnknowns>& d) const {
        int count = 0;
        const auto stencil = operators.stencil(sample);
        const auto gradient = operators.gradient(sample);
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const Complex g = gradient[j], n = nu[sample];
            const auto along = [&](Complex direction) { return 0.5 * (g * direction - n * std::conj(g) * direction); };
            if (decoupled || freedom[stencil[j]] == Freedom::fixed) {
                d[count++] = along(1.0);
            } else if (freedom[stencil[j]] == Freedom::sliding) {
                d[count++] = along(directions[stencil[j]]);
            } else {
                d[count++] = along(1.0);
                d[count++] = along(kI);
            }
        }
        return count;
    }

    double weight(int sample, const Eigen::VectorXcd& of) const {
        return 2 * operators.weights[sample] / (1 - std::norm(of[sample]));
    }
    double weight(int sample) const { return weight(sample, nu); }

    /// @param extra_diagonal see factorize; may be empty
    void assemble(const Eigen::VectorXd& extra_diagonal) {
        if (left.valid()) left.wait();
        system->clear();
        if (decoupled) return assemble_decoupled();
        std::array<Complex, kMostUnknowns> d;
        std::array<double, kMostUnknowns*(kMostUnknowns + 1) / 2> lower;
        for (int s = 0; s < operators.sample_count(); ++s) {
            const int count = element(s, d);
            const double w = weight(s);
            double* entry = lower.data();
            for (int i = 0; i < count; ++i)
                for (int j = 0; j <= i; ++j, ++entry)
                    *entry = w * (d[i].real() * d[j].real() + d[i].imag() * d[j].imag());
            system->add(s, {lower.data(), entry});
        }
        if (extra_diagonal.size() == 0) return;
        for (int v = 0; v < operators.vertex_count; ++v)
            if (const int u = first_unknown[v]; freedom[v] == Freedom::sliding)
                system->add_to_diagonal(u, std::max(extra_diagonal[v], -0.3 * system->diagonal(u)));
    }

    /// Matrices of elements are found beside each other, and then added in turn.
    void assemble_decoupled() {
        const int samples = operators.sample_count();
        std::vector<double> lower(static_cast<std::size_t>(std::min(samples, kSamplesAtOnce)) * most_entries);
        const auto entries_of = [&](int s, int begin) {
            return lower.data() + static_cast<std::ptrdiff_t>(s - begin) * most_entries;
        };
        for (int begin = 0; begin < samples; begin += kSamplesAtOnce) {
            const int end = std::min(samples, begin + kSamplesAtOnce);
            parallel_for(
                begin, end,
                [&](int first, int last) {
                    std::array<Complex, kMostUnknowns> d;
                    for (int s = first; s < last; ++s) {
                        const auto gradient = operators.gradient(s);
                        const double w = weight(s);
                        double* entry = entries_of(s, begin);
                        for (std::size_t i = 0; i < gradient.size(); ++i) {
                            d[i] = 0.5 * (gradient[i] - nu[s] * std::conj(gradient[i]));
                            for (std::size_t j = 0; j <= i; ++j, ++entry)
                                *entry = w * (d[i].real() * d[j].real() + d[i].imag() * d[j].imag());
                        }
                    }
                },
                kSamplesAtOnce / 8);
            for (int s = begin; s < end; ++s) {
                const std::size_t corners = operators.stencil(s).size();
                system->add(s, {entries_of(s, begin), corners * (corners + 1) / 2});
            }
        }
    }

    /// The part of a map that is not solved for: fixed and sliding vertices, 0 at free ones.
    Eigen::VectorXcd base_of(const Eigen::VectorXcd& start) const {
        Eigen::VectorXcd base = start;
        for (int v = 0; v < operators.vertex_count; ++v)
            if (freedom[v] == Freedom::free) base[v] = 0;
        return base;
    }

    /// The mean of the vertices that are not free.
    Complex centre_of(const Eigen::VectorXcd& base) const {
        const auto held = std::count_if(freedom.begin(), freedom.end(), [](Freedom f) { return f != Freedom::free; });
        return held > 0 ? base.sum() / static_cast<double>(held) : 0.0;
    }

    /// −Re[(DB)^H W (D base + offset)]; real and imaginary part as two columns where they decouple.
    /// @param offset #S, or empty for 0
    Eigen::MatrixXd right_hand_side(const Eigen::VectorXcd& base, const Eigen::VectorXcd& offset = {}) const {
        Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(system->unknown_count(), decoupled ? 2 : 1);
        std::array<Complex, kMostUnknowns> d;
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto stencil = operators.stencil(s);
            const Complex more = offset.size() ? offset[s] : 0.0;
            bool any = more != 0.0;
            for (const int v : stencil) any = any || base[v] != 0.0;
            if (!any) continue;
            const auto unknowns = system->nodes(s);
            const int count = element(s, d);
            const double w = weight(s);
            if (decoupled) {
                Complex re = 0, im = 0;  // D of the two real functions
                for (int j = 0; j < count; ++j) {
                    re += d[j] * base[stencil[j]].real();
                    im += d[j] * base[stencil[j]].imag();
                }
                for (int j = 0; j < count; ++j)
                    if (unknowns[j] >= 0) {
                        rhs(unknowns[j], 0) -= w * std::real(std::conj(d[j]) * (re + more));
                        rhs(unknowns[j], 1) -= w * std::real(std::conj(d[j]) * (im - kI * more));
                    }
            } else {
                const auto [dz, dzbar] = operators.derivatives(s, base);
                const Complex residual = dzbar - nu[s] * dz + more;
                for (int j = 0; j < count; ++j)
                    if (unknowns[j] >= 0) rhs(unknowns[j], 0) -= w * std::real(std::conj(d[j]) * residual);
            }
        }
        return rhs;
    }

    /// Adds −Re[(DB)^H W offset] to the right-hand sides of the columns first … last−1 of @p offsets.
    void subtract_offsets(const Eigen::MatrixXcd& offsets, int first, int last, Eigen::MatrixXd& rhs) const {
        std::array<Complex, kMostUnknowns> d;
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto unknowns = system->nodes(s);
            const int count = element(s, d);
            for (int j = 0; j < count; ++j) d[j] *= weight(s);
            for (int column = first; column < last; ++column) {
                const Complex r = offsets(s, column);
                for (int j = 0; j < count; ++j) {
                    const int u = unknowns[j];
                    if (u < 0) continue;
                    if (decoupled) {
                        rhs(u, 2 * column) -= d[j].real() * r.real() + d[j].imag() * r.imag();
                        rhs(u, 2 * column + 1) -= d[j].real() * r.imag() - d[j].imag() * r.real();
                    } else {
                        rhs(u, column) -= d[j].real() * r.real() + d[j].imag() * r.imag();
                    }
                }
            }
        }
    }

    /// The unknowns of a map.
    Eigen::MatrixXd pack(const Eigen::VectorXcd& map, const Eigen::VectorXcd& base) const {
        Eigen::MatrixXd y(system->unknown_count(), decoupled ? 2 : 1);
        for (int v = 0; v < operators.vertex_count; ++v) {
            const int u = first_unknown[v];
            if (u < 0) continue;
            if (decoupled) {
                y(u, 0) = map[v].real();
                y(u, 1) = map[v].imag();
            } else if (freedom[v] == Freedom::sliding) {
                y(u, 0) = std::real(std::conj(directions[v]) * (map[v] - base[v])) / std::norm(directions[v]);
            } else {
                y(u, 0) = map[v].real();
                y(u + 1, 0) = map[v].imag();
            }
        }
        return y;
    }

    Eigen::VectorXcd unpack(const Eigen::MatrixXd& y, const Eigen::VectorXcd& base) const {
        Eigen::VectorXcd f = base;
        for (int v = 0; v < operators.vertex_count; ++v) {
            const int u = first_unknown[v];
            if (u < 0) continue;
            if (decoupled) {
                f[v] = Complex(y(u, 0), y(u, 1));
            } else if (freedom[v] == Freedom::sliding) {
                f[v] += y(u, 0) * directions[v];
            } else {
                f[v] = Complex(y(u, 0), y(u + 1, 0));
            }
        }
        return f;
    }

    /// The work on a large system that cannot be stopped is not waited for then.
    void unless_stopped(std::function<void()> work) {
        if (static_cast<int>(owner.size()) < kLarge) return work();
        run_unless_stopped(std::move(work), left);
    }

    /// Factorises the assembled matrix; failures name vertices instead of unknowns.
    void factorize() {
        try {
            unless_stopped([system = system] { system->factorize(); });
        } catch (const Error& error) {
            std::vector<int> vertices;
            for (const int unknown : error.indices()) vertices.push_back(owner[unknown]);
            std::sort(vertices.begin(), vertices.end());
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
            if (vertices.empty()) throw;
            std::string named;
            for (std::size_t i = 0; i < std::min<std::size_t>(vertices.size(), 10); ++i)
                named += (i ? ", " : "") + std::to_string(vertices[i]);
            if (vertices.size() > 10) named += " and " + std::to_string(vertices.size() - 10) + " more";
            throw Error(Cause::not_solved, "the map is not determined at the vertices " + named,
                        "pin at least one vertex of every component, two where the boundary is free",
                        {Things::vertices, std::move(vertices)});
        }
    }
};

BeltramiSolver::BeltramiSolver(const Surface& source, std::vector<Freedom> freedoms, int expected_factorizations)
    : implementation_(std::make_unique<Implementation>(source, std::move(freedoms), expected_factorizations)) {}
BeltramiSolver::~BeltramiSolver() = default;
BeltramiSolver::BeltramiSolver(BeltramiSolver&&) noexcept = default;

const std::vector<Freedom>& BeltramiSolver::freedoms() const {
    return implementation_->freedom;
}
bool BeltramiSolver::decoupled() const {
    return implementation_->decoupled;
}
int BeltramiSolver::factorization_count() const {
    return implementation_->system->factorization_count();
}

void BeltramiSolver::factorize(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& directions,
                               const Eigen::VectorXd& extra_diagonal) {
    Implementation& m = *implementation_;
    m.nu = nu;
    m.directions = directions;
    m.assemble(extra_diagonal);
    m.factorize();
}

Eigen::VectorXcd BeltramiSolver::solve(const Eigen::VectorXcd& start) const {
    const Implementation& m = *implementation_;
    const Eigen::VectorXcd base = m.base_of(start);
    return m.unpack(m.system->solve(m.right_hand_side(base)), base);
}

Eigen::VectorXcd BeltramiSolver::solve(const Eigen::VectorXcd& start, const Eigen::VectorXcd& offset) const {
    const Implementation& m = *implementation_;
    const Eigen::VectorXcd base = m.base_of(start);
    return m.unpack(m.system->solve(m.right_hand_side(base, offset)), base);
}

Eigen::MatrixXcd BeltramiSolver::solve_offsets(const Eigen::MatrixXcd& offsets) const {
    const Implementation& m = *implementation_;
    const int count = static_cast<int>(offsets.cols());
    const Eigen::Index each = m.decoupled ? 2 : 1;  // columns of the system for each of them
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(m.system->unknown_count(), each * count);
    parallel_for(
        0, count, [&](int first, int last) { m.subtract_offsets(offsets, first, last, rhs); }, kOffsetsAtOnce);
    const Eigen::MatrixXd y = m.system->solve(rhs);
    const Eigen::VectorXcd base = Eigen::VectorXcd::Zero(m.operators.vertex_count);
    Eigen::MatrixXcd result(m.operators.vertex_count, count);
    parallel_for_each(count, [&](int j) { result.col(j) = m.unpack(y.middleCols(each * j, each), base); });
    return result;
}

Eigen::VectorXd BeltramiSolver::solve_poisson(const Eigen::VectorXd& load) const {
    const Implementation& m = *implementation_;
    if (!m.decoupled) throw std::logic_error("BeltramiSolver::solve_poisson needs a fixed boundary");
    Eigen::MatrixXd rhs(m.system->unknown_count(), 1);
    // The matrix is that of ½ ∫ ∇u·∇v.
    for (Eigen::Index u = 0; u < rhs.rows(); ++u) rhs(u, 0) = 0.5 * load[m.owner[u]];
    const Eigen::MatrixXd y = m.system->solve(rhs);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(m.operators.vertex_count);
    for (Eigen::Index u = 0; u < rhs.rows(); ++u) result[m.owner[u]] = y(u, 0);
    return result;
}

Eigen::VectorXcd BeltramiSolver::solve_near(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& start,
                                            const Eigen::VectorXcd& guess, double tolerance) {
    return solve_near(nu, implementation_->directions, {}, start, guess, tolerance);
}

Eigen::VectorXcd BeltramiSolver::solve_near(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& directions,
                                            const Eigen::VectorXd& extra_diagonal, const Eigen::VectorXcd& start,
                                            const Eigen::VectorXcd& guess, double tolerance) {
    Implementation& m = *implementation_;
    if (m.system->factorization_count() == 0) {
        factorize(nu, directions, extra_diagonal);
        return solve(start);
    }
    m.nu = nu;
    m.directions = directions;
    m.assemble(extra_diagonal);
    // The size of the solution, which measures the error, must not depend on where the image lies.
    const Eigen::VectorXcd base = m.base_of(start);
    const Complex centre = m.centre_of(base);
    const Eigen::VectorXcd centred = m.base_of(start.array() - centre);
    const Eigen::MatrixXd rhs = m.right_hand_side(centred);
    Eigen::MatrixXd y = m.pack(guess.array() - centre, centred);
    if (!m.system->solve_near(rhs, y, std::max(tolerance, kNearTolerance), kMostNearSteps)) {
        m.factorize();
        y = m.system->solve(rhs);
    }
    Eigen::VectorXcd map = m.unpack(y, base);
    for (int v = 0; v < m.operators.vertex_count; ++v)
        if (m.freedom[v] == Freedom::free) map[v] += centre;
    return map;
}

Eigen::VectorXcd BeltramiSolver::gradient(const Eigen::VectorXcd& f, const Eigen::VectorXcd& nu) const {
    const Implementation& m = *implementation_;
    Eigen::VectorXcd force = Eigen::VectorXcd::Zero(m.operators.vertex_count);
    for (int s = 0; s < m.operators.sample_count(); ++s) {
        const auto [dz, dzbar] = m.operators.derivatives(s, f);
        const Complex residual = dzbar - nu[s] * dz;
        const double weight = m.weight(s, nu);
        const auto stencil = m.operators.stencil(s);
        const auto gradients = m.operators.gradient(s);
        // d/d(Re f_j) and d/d(Im f_j) of ½ w |residual|², as one complex number.
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const Complex g = gradients[j];
            const double x = std::real(std::conj(0.5 * (g - nu[s] * std::conj(g))) * residual);
            const double y = std::real(std::conj(0.5 * kI * (g - nu[s] * std::conj(g))) * residual);
            force[stencil[j]] += weight * Complex(x, y);
        }
    }
    return force;
}

Eigen::VectorXcd BeltramiSolver::gradient(const Eigen::VectorXcd& f) const {
    return gradient(f, implementation_->nu);
}

Eigen::VectorXcd harmonic_map(const Surface& source, const BoundaryCondition& boundary, int expected_factorizations) {
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    BeltramiSolver solver(source, freedoms(boundary, source), expected_factorizations);
    solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()), line_directions(boundary, source));
    return solver.solve(prescribed_values(boundary, source));
}

namespace {

/// Two boundary vertices far apart, with their distance: the farthest from the first, then the farthest from that.
BoundaryCondition far_pins(const Surface& source) {
    if (source.topology.boundary_loops.empty())
        throw Error(Cause::bad_boundary, "a closed surface has no conformal map to the plane",
                    "cut it open or pin two vertices");
    const auto& loop = source.topology.boundary_loops[0];
    const auto farthest = [&](int from) {
        int best = from;
        double most = -1;
        for (const int v : loop) {
            const double d = (source.mesh.point(v) - source.mesh.point(from)).squaredNorm();
            if (d > most) most = d, best = v;
        }
        return best;
    };
    const int a = farthest(loop[0]), b = farthest(a);
    BoundaryCondition pins;
    pins.pin(a, 0.0);
    pins.pin(b, (source.mesh.point(b) - source.mesh.point(a)).norm());
    return pins;
}

}  // namespace

Eigen::VectorXcd least_squares_conformal_map(const Surface& source, const BoundaryCondition& boundary) {
    validate(boundary, source);
    const BoundaryCondition pins = boundary.empty() ? far_pins(source) : boundary;
    bool two_points = false;
    for (const Complex image : pins.images) two_points = two_points || image != pins.images[0];
    if (!two_points)
        throw Error(Cause::bad_boundary, "a conformal map needs two pins with different images",
                    "pin two vertices, or none", {Things::vertices, pins.vertices});
    BeltramiSolver solver(source, freedoms(pins, source), 1);
    solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()), line_directions(pins, source));
    return solver.solve(prescribed_values(pins, source));
}

}  // namespace beltrami
