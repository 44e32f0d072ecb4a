#include <beltrami/space/unrolled_problem.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/base/constants.h>

namespace beltrami {

namespace {

constexpr int kSolves = 40;
constexpr double kStepShift = 1e-10;  // of the diagonal of steps

/// #V the numbers of those that move, −1 elsewhere.
std::vector<int> places_of_moving(const Operators& operators, const std::vector<char>& fixed) {
    std::vector<int> place(fixed.size(), -1);
    int count = 0;
    for (const int v : operators.vertices)
        if (!fixed[v] && place[v] < 0) place[v] = count++;
    return place;
}

ElementSystem system_of(const Operators& operators, const std::vector<int>& place, int block) {
    std::vector<int> nodes;
    nodes.reserve(operators.vertices.size());
    for (const int v : operators.vertices) nodes.push_back(place[v]);
    const int count = place.empty() ? 0 : *std::max_element(place.begin(), place.end()) + 1;
    return {operators.offsets, std::move(nodes), count, kSolves, block};
}

}  // namespace

UnrolledProblem::UnrolledProblem(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                                 const std::vector<char>& fixed)
    : faces_(source.faces),
      operators_(elements.operators),
      of_corners_(per_corner(elements.operators, source.faces)),
      turns_(places.turns),
      place_(places_of_moving(elements.operators, fixed)),
      map_(places.vertices),
      system_(system_of(elements.operators, place_, 1)) {}

Eigen::VectorXcd UnrolledProblem::corners() const {
    Eigen::VectorXcd result = turns_;
    for (int c = 0; c < faces_.corner_count(); ++c) result[c] += map_[faces_.vertices()[c]];
    return result;
}

void UnrolledProblem::solve(const Eigen::VectorXcd& nu) {
    system_.clear();
    const Eigen::VectorXcd at = corners();
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(system_.unknown_count(), 2);
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const auto v = operators_.stencil(s), corner = of_corners_.stencil(s);
        const auto g = operators_.gradient(s);
        const double weight = operators_.weights[s] / (1 - std::norm(nu[s]));
        std::array<Complex, 3> c;
        Complex along_x = 0, along_y = 0;
        for (int j = 0; j < 3; ++j) {
            c[j] = 0.5 * (g[j] - nu[s] * std::conj(g[j]));
            along_x += c[j] * at[corner[j]].real();
            along_y += c[j] * at[corner[j]].imag();
        }
        std::array<double, 6> lower{};
        for (int j = 0, entry = 0; j < 3; ++j) {
            for (int k = 0; k <= j; ++k) lower[entry++] = weight * std::real(std::conj(c[j]) * c[k]);
            if (place_[v[j]] < 0) continue;
            gradient(place_[v[j]], 0) += weight * std::real(std::conj(c[j]) * along_x);
            gradient(place_[v[j]], 1) += weight * std::real(std::conj(c[j]) * along_y);
        }
        system_.add(s, lower);
    }
    system_.factorize();
    const Eigen::MatrixXd change = system_.solve(gradient);
    for (std::size_t v = 0; v < place_.size(); ++v)
        if (const int i = place_[v]; i >= 0) map_[static_cast<Eigen::Index>(v)] -= Complex(change(i, 0), change(i, 1));
}

Eigen::VectorXcd UnrolledProblem::step(const TargetEnergy& energy) {
    const MapDerivatives map = derivatives();
    if (!steps_) steps_.emplace(system_of(operators_, place_, 2));
    ElementSystem& system = *steps_;
    system.clear();
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(system.unknown_count());
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const auto stencil = operators_.stencil(s);
        if (std::all_of(stencil.begin(), stencil.end(), [&](int v) { return place_[v] < 0; })) continue;
        const auto g = operators_.gradient(s);
        const SampleTerm term = energy.term(plane_frame(map.dz[s], map.dzbar[s]), s);
        std::array<Complex, 6> v;
        std::array<double, 21> hessian;
        for (std::size_t i = 0, entry = 0; i < v.size(); ++i) {
            const Complex to = g[i / 2], of_vertex = 0.5 * (i % 2 ? kI : 1.0);
            v[i] = term.of_dzbar * of_vertex * to + term.of_dz * of_vertex * std::conj(to);
            if (const int node = place_[stencil[i / 2]]; node >= 0)
                gradient[2 * node + static_cast<int>(i % 2)] += std::real(std::conj(term.gradient) * v[i]);
            for (std::size_t j = 0; j <= i; ++j)
                hessian[entry++] = term.along * v[i].real() * v[j].real() + term.across * v[i].imag() * v[j].imag();
        }
        system.add(s, hessian);
    }
    system.scale_diagonal(1 + kStepShift);
    system.factorize();
    const Eigen::VectorXd change = system.solve(gradient);
    Eigen::VectorXcd way = Eigen::VectorXcd::Zero(map_.size());
    for (std::size_t v = 0; v < place_.size(); ++v)
        if (const int i = place_[v]; i >= 0)
            way[static_cast<Eigen::Index>(v)] = -Complex(change[2 * i], change[2 * i + 1]);
    return way;
}

double UnrolledProblem::best_step(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) const {
    const MapDerivatives map = derivatives();
    double along = 0, square = 0;
    for (Eigen::Index s = 0; s < map.dz.size(); ++s) {
        const double weight = operators_.weights[static_cast<std::size_t>(s)];
        const Complex way = (to[s] - from[s]) * map.dz[s];
        along += weight * std::real(std::conj(way) * (map.dzbar[s] - from[s] * map.dz[s]));
        square += weight * std::norm(way);
    }
    return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 1;
}

}  // namespace beltrami
