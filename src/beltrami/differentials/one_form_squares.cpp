#include <beltrami/differentials/one_form_squares.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <beltrami/base/error.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/linear/dense.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

/// Products of harmonic measures whose Gram matrix has a smaller eigenvalue, relative to the largest, do not span.
/// Mesh noise is about 1e-3 in the squares.
constexpr double kLeastEigenvalue = 3e-3;

/// ∫|∇u|² = 4 ∫|∂u|².
double energy(const Operators& operators, const Eigen::VectorXd& u) {
    const Eigen::VectorXcd values = u.cast<Complex>();
    double sum = 0;
    for (int s = 0; s < operators.sample_count(); ++s)
        sum += 4 * operators.weights[s] * std::norm(operators.derivatives(s, values)[0]);
    return sum;
}

/// The boundary vertices from one corner to the next, both included, for each of the four sides.
std::array<std::vector<int>, 4> sides_of(const Surface& source, const std::array<int, 4>& corners) {
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const std::vector<int> named(corners.begin(), corners.end());
    std::array<std::size_t, 4> at{};
    for (int i = 0; i < 4; ++i) {
        const auto found = std::find(loop.begin(), loop.end(), corners[i]);
        if (found == loop.end())
            throw Error(Cause::bad_boundary, "corner " + std::to_string(corners[i]) + " is no boundary vertex",
                        "name four boundary vertices", {Things::vertices, {corners[i]}});
        at[i] = static_cast<std::size_t>(found - loop.begin());
    }
    std::array<std::vector<int>, 4> sides;
    std::size_t length = 0;
    for (int i = 0; i < 4; ++i) {
        const std::size_t steps = (at[(i + 1) % 4] + loop.size() - at[i]) % loop.size();
        for (std::size_t j = 0; j <= steps; ++j) sides[i].push_back(loop[(at[i] + j) % loop.size()]);
        length += steps;
        if (steps == 0) length += 2 * loop.size();
    }
    if (length != loop.size())
        throw Error(Cause::bad_boundary, "the corners do not follow each other along the boundary",
                    "name four different boundary vertices counter-clockwise", {Things::vertices, named});
    return sides;
}

}  // namespace

QuadrilateralSpace quadrilateral_space(const Surface& source, const std::array<int, 4>& corners) {
    require_disk(source);
    const auto sides = sides_of(source, corners);
    const Operators& operators = source.operators;
    /// 0 on one side and 1 on the opposite one.
    const auto across = [&](int zero, int one) {
        Eigen::VectorXd values = Eigen::VectorXd::Zero(operators.vertex_count);
        std::vector<char> fixed(operators.vertex_count, 0);
        for (const int v : sides[zero]) fixed[v] = 1;
        for (const int v : sides[one]) fixed[v] = 1, values[v] = 1;
        return Eigen::VectorXd(detail::Laplacian(operators, fixed).extend(values));
    };
    const Eigen::VectorXd u = across(3, 1), v = across(0, 2);
    QuadrilateralSpace result{TabulatedSpace(Eigen::MatrixXcd(operators.sample_count(), 0)), {}, 0, 0, 0};
    result.modulus_upper = energy(operators, u);
    result.modulus_lower = 1 / energy(operators, v);
    result.modulus = std::sqrt(result.modulus_upper * result.modulus_lower);
    result.map.resize(operators.vertex_count);
    result.map.real() = u;
    result.map.imag() = result.modulus * v;
    Eigen::MatrixXcd phi(operators.sample_count(), 1);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const Complex dz = operators.derivatives(s, result.map)[0];
        phi(s, 0) = dz * dz;
    }
    result.space = TabulatedSpace(std::move(phi));
    return result;
}

TabulatedSpace one_form_products(const Surface& source) {
    require_genus_zero(source);
    const auto& loops = source.topology.boundary_loops;
    const int holes = static_cast<int>(loops.size()) - 1, dimension = dimension_of_differentials(holes, 0);
    if (holes < 2)
        throw Error(Cause::bad_mesh, "products of harmonic measures need two holes or more",
                    "take another space of differentials");
    const Operators& operators = source.operators;
    const Eigen::Index samples = operators.sample_count();
    const detail::Laplacian laplacian(operators, source.topology.on_boundary);
    Eigen::MatrixXcd forms(samples, holes);
    for (int i = 0; i < holes; ++i) {
        Eigen::VectorXd values = Eigen::VectorXd::Zero(operators.vertex_count);
        for (const int v : loops[i + 1]) values[v] = 1;
        const Eigen::VectorXcd u = laplacian.extend(values).cast<Complex>();
        for (int s = 0; s < samples; ++s) forms(s, i) = 2.0 * operators.derivatives(s, u)[0];
    }
    const auto areas = Eigen::Map<const Eigen::VectorXd>(operators.weights.data(), samples);
    Eigen::MatrixXcd products(samples, holes * (holes + 1) / 2);
    Eigen::Index count = 0;
    for (int i = 0; i < holes; ++i)
        for (int j = i; j < holes; ++j) {
            const Eigen::VectorXcd product = forms.col(i).cwiseProduct(forms.col(j));
            products.col(count++) = product / std::sqrt(areas.dot(product.cwiseAbs2()));
        }
    Eigen::MatrixXd both(2 * samples, count);
    both << areas.cwiseSqrt().asDiagonal() * products.real(), areas.cwiseSqrt().asDiagonal() * products.imag();
    const SymmetricEigen eigen = symmetric_eigen(gram_lower(both));
    const Eigen::VectorXd values = eigen.values.reverse();
    if (values.size() < dimension || !(values[dimension - 1] > kLeastEigenvalue * values[0])) {
        std::ostringstream listed;
        listed.precision(2);
        for (Eigen::Index i = 0; i < values.size(); ++i) listed << (i ? ", " : "") << values[i];
        throw Error(Cause::not_solved,
                    "products of harmonic measures do not span the " + std::to_string(dimension) +
                        " quadratic differentials; eigenvalues: " + listed.str(),
                    "holes in one line or otherwise symmetric need another space of differentials");
    }
    const Eigen::VectorXd scales = values.head(dimension).cwiseSqrt().cwiseInverse();
    return TabulatedSpace(complex_product(
        products, (eigen.vectors.rowwise().reverse().leftCols(dimension) * scales.asDiagonal()).cast<Complex>()));
}

}  // namespace beltrami
