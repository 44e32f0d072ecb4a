#include <beltrami/space/unrolled_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <beltrami/linear/element_system.h>
#include <beltrami/space/uniform_iteration.h>

namespace beltrami {

namespace {

constexpr int kExpectedFactorizations = 40;

/// Least-squares maps to the unrolled surface. With |dz + ν dz̄|² as the metric of the source their energy is
/// Dirichlet's of both coordinates, less the area of the image, which does not change: two systems with one matrix.
class UnrolledProblem {
  public:
    UnrolledProblem(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                    const std::vector<char>& fixed)
        : operators_(elements.operators),
          place_(fixed.size(), -1),
          turns_(turns_of_samples(source.faces, elements.operators, places.turns)),
          map_(places.vertices),
          system_(system_of(fixed)) {}

    const Eigen::VectorXcd& map() const { return map_; }

    void solve(const Eigen::VectorXcd& nu) {
        system_.clear();
        Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(system_.unknown_count(), 2);
        for (int s = 0; s < operators_.sample_count(); ++s) {
            const auto v = operators_.stencil(s);
            const auto g = operators_.gradient(s);
            const double weight = operators_.weights[s] / (1 - std::norm(nu[s]));
            std::array<Complex, 3> c;
            Complex along_x = 0, along_y = 0;
            for (int j = 0; j < 3; ++j) {
                c[j] = 0.5 * (g[j] - nu[s] * std::conj(g[j]));
                const Complex at = value(s, j);
                along_x += c[j] * at.real();
                along_y += c[j] * at.imag();
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
            if (const int i = place_[v]; i >= 0)
                map_[static_cast<Eigen::Index>(v)] -= Complex(change(i, 0), change(i, 1));
    }

    Eigen::VectorXcd coefficients() const {
        Eigen::VectorXcd mu(operators_.sample_count());
        for (int s = 0; s < mu.size(); ++s) {
            const auto [d_z, d_zbar] = derivatives(s);
            mu[s] = d_zbar / d_z;
        }
        return cut_off_means(operators_, std::move(mu));
    }

    /// Where Σ A |∂̄f − ν ∂f|² is least on the way.
    double best_step(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) const {
        double along = 0, square = 0;
        for (int s = 0; s < operators_.sample_count(); ++s) {
            const auto [d_z, d_zbar] = derivatives(s);
            const Complex way = (to[s] - from[s]) * d_z;
            along += operators_.weights[s] * std::real(std::conj(way) * (d_zbar - from[s] * d_z));
            square += operators_.weights[s] * std::norm(way);
        }
        return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 1;
    }

  private:
    static std::vector<std::array<Complex, 3>> turns_of_samples(const FaceList& faces, const Operators& operators,
                                                                const Eigen::VectorXcd& turns) {
        std::vector<std::array<Complex, 3>> result(static_cast<std::size_t>(operators.sample_count()));
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto face = faces[operators.faces[s]];
            const int first = faces.first_corner(operators.faces[s]);
            for (int j = 0; j < 3; ++j)
                result[s][j] =
                    turns[first + (std::find(face.begin(), face.end(), operators.stencil(s)[j]) - face.begin())];
        }
        return result;
    }

    ElementSystem system_of(const std::vector<char>& fixed) {
        int count = 0;
        for (const int v : operators_.vertices)
            if (!fixed[v] && place_[v] < 0) place_[v] = count++;
        std::vector<int> nodes;
        nodes.reserve(operators_.vertices.size());
        for (const int v : operators_.vertices) nodes.push_back(place_[v]);
        return {operators_.offsets, std::move(nodes), count, kExpectedFactorizations};
    }

    Complex value(int sample, int j) const { return map_[operators_.stencil(sample)[j]] + turns_[sample][j]; }

    std::array<Complex, 2> derivatives(int sample) const {
        const auto g = operators_.gradient(sample);
        Complex d_z = 0, d_zbar = 0;
        for (int j = 0; j < 3; ++j) {
            d_z += 0.5 * std::conj(g[j]) * value(sample, j);
            d_zbar += 0.5 * g[j] * value(sample, j);
        }
        return {d_z, d_zbar};
    }

    const Operators& operators_;
    std::vector<int> place_;  // #V among those that move
    std::vector<std::array<Complex, 3>> turns_;
    Eigen::VectorXcd map_;
    ElementSystem system_;
};

}  // namespace

std::optional<UnrolledPlaces> unrolled_places(const ParametricTarget& target, const FaceList& faces,
                                              const Target::Points& points) {
    const std::optional<ParametricTarget::Unrolled> plane = target.unrolled();
    if (!plane) return {};
    UnrolledPlaces result{Eigen::VectorXcd(points.size()), Eigen::VectorXcd::Zero(faces.corner_count())};
    for (std::size_t v = 0; v < points.size(); ++v) {
        const Eigen::Vector2d at = plane->unit.cwiseProduct(points[v].parameters);
        result.vertices[static_cast<Eigen::Index>(v)] = {at.x(), at.y()};
    }
    const auto turns = [](double away, double turn) { return turn > 0 ? -turn * std::round(away / turn) : 0.0; };
    for (int f = 0; f < faces.size(); ++f)
        for (int j = 1; j < faces.degree(f); ++j) {
            const Complex away = result.vertices[faces[f][j]] - result.vertices[faces[f][0]];
            result.turns[faces.first_corner(f) + j] = {turns(away.real(), plane->turns.x()),
                                                       turns(away.imag(), plane->turns.y())};
        }
    return result;
}

Target::Points rolled_up(const ParametricTarget& target, const Eigen::VectorXcd& vertices) {
    const Eigen::Vector2d unit = target.unrolled().value().unit;
    Target::Points points;
    points.reserve(static_cast<std::size_t>(vertices.size()));
    for (const Complex& z : vertices) points.push_back(target.at(z.real() / unit.x(), z.imag() / unit.y()));
    return points;
}

Eigen::VectorXcd unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                              const std::vector<char>& fixed, const Eigen::VectorXcd& mu) {
    UnrolledProblem problem(source, elements, places, fixed);
    problem.solve(mu);
    return problem.map();
}

UnrolledMap uniform_unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                                 const std::vector<char>& fixed, const UniformOptions& options) {
    options.validate();
    UnrolledProblem problem(source, elements, places, fixed);
    problem.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
    UnrolledMap result;
    result.first = problem.map();
    const UniformRun run = iterate_to_uniform(
        elements, source,
        {[&](const Eigen::VectorXcd& mu) { problem.solve(mu); }, [&] { return problem.coefficients(); },
         [&](const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) { return problem.best_step(from, to); }},
        options);
    result.vertices = problem.map();
    result.solves = 1 + run.solves;
    result.converged = run.converged;
    return result;
}

}  // namespace beltrami
