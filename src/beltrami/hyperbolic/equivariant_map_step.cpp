#include <beltrami/hyperbolic/equivariant_map_step.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/hyperbolic/face_chart.h>

namespace beltrami {

namespace {

constexpr double kLongestStep = 3;      // hyperbolic, of a vertex in one step
constexpr double kArmijo = 1e-4;        // part of the slope that a step must gain
constexpr double kRounding = 1e-13;     // of the energy
constexpr double kShortestStep = 1e-6;  // part of a step
constexpr double kLeastWeight = 1e-3;   // of the mean, where a direction does not descend
constexpr double kTwoStepsAbove = 0.6;  // |ν|
constexpr int kMostSteps = 200;

ElementSystem system_of(const Surface& source) {
    std::vector<int> offsets{0}, nodes;
    for (const auto& [a, b] : source.topology.edges) {
        nodes.insert(nodes.end(), {a, b});
        offsets.push_back(static_cast<int>(nodes.size()));
    }
    constexpr int many = 20;
    return {std::move(offsets), std::move(nodes), source.mesh.vertex_count(), many, 2};
}

/// What an edge adds to the energy's derivatives: its length, and unit vectors at both ends towards each other.
struct EdgeTerms {
    double length, stretched, shrunk;  // d, d coth d, d / sinh d
    Complex at_first, at_second;

    explicit EdgeTerms(const DiskIsometry& step)
        : length(step.distance()),
          stretched(1),
          shrunk(1),
          at_first(step.direction()),
          at_second(step.inverse().direction()) {
        if (length < 1e-6) return;
        stretched = length / std::tanh(length);
        shrunk = length / std::sinh(length);
    }

    /// Takes an unknown out of a lower triangle: its row and its column.
    static void clear(std::array<double, 10>& lower, std::size_t unknown) {
        for (std::size_t other = 0; other < 4; ++other) {
            const std::size_t row = std::max(unknown, other), column = std::min(unknown, other);
            lower[row * (row + 1) / 2 + column] = 0;
        }
    }

    /// Lower triangle of w [r rᵀ + d coth d (P Pᵀ + Q Qᵀ) − d/sinh d (P Qᵀ + Q Pᵀ)], r along the edge, P and Q across
    /// it at its ends.
    std::array<double, 10> full(double weight) const {
        const Complex i(0, 1), across_first = i * at_first, across_second = -i * at_second;
        const std::array<double, 4> r{-at_first.real(), -at_first.imag(), -at_second.real(), -at_second.imag()},
            p{across_first.real(), across_first.imag(), 0, 0}, q{0, 0, across_second.real(), across_second.imag()};
        std::array<double, 10> lower{};
        std::size_t entry = 0;
        for (std::size_t x = 0; x < 4; ++x)
            for (std::size_t y = 0; y <= x; ++y)
                lower[entry++] = weight * (r[x] * r[y] + stretched * (p[x] * p[y] + q[x] * q[y]) -
                                           shrunk * (p[x] * q[y] + q[x] * p[y]));
        return lower;
    }
    /// The same with half of the curvature term: Hermitian in the complex displacements.
    std::array<double, 10> hermitian(double weight) const {
        const double diagonal = weight * (1 + 0.5 * (stretched - 1));
        const Complex off = -weight * (1 - 0.5 * (1 - shrunk)) * -at_second * std::conj(at_first);
        return {diagonal, 0, diagonal, off.real(), -off.imag(), diagonal, off.imag(), off.real(), 0, diagonal};
    }
};

}  // namespace

EquivariantMapStep::EquivariantMapStep(const Surface& source, EquivariantMap map)
    : source_(source), map_(std::move(map)), system_(system_of(source)) {
    require_triangles(source);
    set_weights(Eigen::VectorXcd::Zero(source.operators.sample_count()));
}

void EquivariantMapStep::set_weights(const Eigen::VectorXcd& nu) {
    const Operators& operators = source_.operators;
    weights_.assign(static_cast<std::size_t>(source_.topology.edge_count()), 0);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const double determinant = 1 - std::norm(nu[s]);
        const auto gradients = operators.gradient(s);
        const int first = source_.mesh.faces.first_corner(operators.faces[s]);
        for (std::size_t k = 0; k < 3; ++k) {
            // The Dirichlet form of z + ν z̄ on two hat functions: (1 + |ν|²) ⟨g, h⟩ − 2 Re ν̄ g h over 1 − |ν|².
            const Complex g = gradients[k], h = gradients[(k + 1) % 3];
            const double form =
                std::real(std::conj(g) * h) * (1 + std::norm(nu[s])) - 2 * std::real(std::conj(nu[s]) * g * h);
            weights_[static_cast<std::size_t>(source_.topology.corner_edges[first + static_cast<int>(k)])] -=
                operators.weights[s] / determinant * form;
        }
    }
}

double EquivariantMapStep::energy_of(const std::vector<DiskIsometry>& steps) const {
    double energy = 0;
    for (std::size_t e = 0; e < steps.size(); ++e) {
        const double length = steps[e].distance();
        energy += 0.5 * weights_[e] * length * length;
    }
    return energy;
}

Eigen::VectorXcd EquivariantMapStep::gradient() const {
    Eigen::VectorXcd result = Eigen::VectorXcd::Zero(source_.mesh.vertex_count());
    for (std::size_t e = 0; e < weights_.size(); ++e) {
        const auto [a, b] = source_.topology.edges[e];
        const EdgeTerms edge(map_.steps[e]);
        result[a] -= weights_[e] * edge.length * edge.at_first;
        result[b] -= weights_[e] * edge.length * edge.at_second;
    }
    for (const std::vector<int>& loop : source_.topology.boundary_loops)
        for (const int v : loop) result[v] = result[v].real();
    return result;
}

Eigen::VectorXcd EquivariantMapStep::direction(Hessian kind, const Eigen::VectorXcd& gradient,
                                               const std::vector<double>& weights) {
    system_.clear();
    for (std::size_t e = 0; e < weights.size(); ++e) {
        const EdgeTerms edge(map_.steps[e]);
        std::array<double, 10> lower = kind == Hessian::full ? edge.full(weights[e]) : edge.hermitian(weights[e]);
        // Along the boundary ξ is real.
        const auto [a, b] = source_.topology.edges[e];
        if (source_.topology.on_boundary[a]) EdgeTerms::clear(lower, 1);
        if (source_.topology.on_boundary[b]) EdgeTerms::clear(lower, 3);
        system_.add(static_cast<int>(e), lower);
    }
    for (Eigen::Index v = 0; v < gradient.size(); ++v)  // vertices without faces, and across the boundary
        for (const int unknown : {static_cast<int>(2 * v), static_cast<int>(2 * v + 1)})
            if (system_.diagonal(unknown) == 0) system_.add_to_diagonal(unknown, 1);
    system_.factorize();
    Eigen::MatrixXd pairs(2 * gradient.size(), 1);
    for (Eigen::Index v = 0; v < gradient.size(); ++v) {
        pairs(2 * v, 0) = -gradient[v].real();
        pairs(2 * v + 1, 0) = -gradient[v].imag();
    }
    pairs = system_.solve(pairs);
    Eigen::VectorXcd xi(gradient.size());
    for (Eigen::Index v = 0; v < xi.size(); ++v) xi[v] = {pairs(2 * v, 0), pairs(2 * v + 1, 0)};
    return xi;
}

std::vector<DiskIsometry> EquivariantMapStep::moved(const Eigen::VectorXcd& xi, double length) const {
    std::vector<DiskIsometry> steps(map_.steps.size());
    for (std::size_t e = 0; e < steps.size(); ++e) {
        const auto [a, b] = source_.topology.edges[e];
        steps[e] =
            (DiskIsometry::translation(-length * xi[a]) * map_.steps[e] * DiskIsometry::translation(length * xi[b]))
                .normalized();
    }
    return steps;
}

/// One step down the energy. @return the largest displacement
double EquivariantMapStep::step(Hessian kind) {
    const Eigen::VectorXcd g = gradient();
    const auto slope_of = [&](const Eigen::VectorXcd& xi) { return std::real(g.dot(xi)); };
    Eigen::VectorXcd xi;
    bool descends = false;
    try {
        xi = direction(kind, g, weights_);
        descends = !(slope_of(xi) > 0) && xi.allFinite();
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
    }
    if (!descends) {
        // Negative weights have spoiled the matrix: one that is positive whatever they are.
        double mean = 0;
        for (const double w : weights_) mean += std::abs(w) / static_cast<double>(weights_.size());
        std::vector<double> positive = weights_;
        for (double& w : positive) w = std::max(w, kLeastWeight * mean);
        xi = direction(kind, g, positive);
    }
    const double slope = slope_of(xi), before = energy(), largest = xi.cwiseAbs().maxCoeff();
    double length = largest > kLongestStep ? kLongestStep / largest : 1;
    std::vector<DiskIsometry> steps;
    while (true) {
        steps = moved(xi, length);
        const bool down = energy_of(steps) <= before + kArmijo * length * slope + kRounding * std::abs(before);
        if (down || length < kShortestStep) break;
        length /= 2;
    }
    map_.steps = std::move(steps);
    for (Eigen::Index v = 0; v < xi.size(); ++v) {
        DiskIsometry& frame = map_.frames[static_cast<std::size_t>(v)];
        frame = (frame * DiskIsometry::translation(length * xi[v])).normalized();
    }
    return length * largest;
}

void EquivariantMapStep::solve(const Eigen::VectorXcd& nu, double /*tolerance*/) {
    set_weights(nu);
    const int steps = nu.cwiseAbs().maxCoeff() > kTwoStepsAbove ? 2 : 1;
    for (int i = 0; i < steps; ++i) step(Hessian::hermitian);
}

int EquivariantMapStep::relax(double tolerance) {
    set_weights(Eigen::VectorXcd::Zero(source_.operators.sample_count()));
    for (int i = 1; i <= kMostSteps; ++i)
        if (step(Hessian::full) < tolerance) return i;
    throw Error(Cause::not_solved, "the harmonic map has not settled in " + std::to_string(kMostSteps) + " steps",
                "remesh the source, with edges of like length side by side");
}

MapDerivatives EquivariantMapStep::derivatives() const {
    const Operators& operators = source_.operators;
    const int samples = operators.sample_count();
    MapDerivatives result{Eigen::VectorXcd::Zero(samples), Eigen::VectorXcd::Zero(samples), 0};
    parallel_for(0, samples, [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const int first = source_.mesh.faces.first_corner(operators.faces[s]);
            const FaceChart chart(step_at_corner(source_, map_, first), step_at_corner(source_, map_, first + 2));
            const auto gradients = operators.gradient(s);
            for (std::size_t k = 0; k < 3; ++k) {
                result.dz[s] += 0.5 * chart.place(k) * std::conj(gradients[k]);
                result.dzbar[s] += 0.5 * chart.place(k) * gradients[k];
            }
        }
    });
    double area = 0;
    for (int s = 0; s < samples; ++s)
        area += operators.weights[s] * std::abs(std::norm(result.dz[s]) - std::norm(result.dzbar[s]));
    result.image_diameter = std::sqrt(area);
    return result;
}

}  // namespace beltrami
