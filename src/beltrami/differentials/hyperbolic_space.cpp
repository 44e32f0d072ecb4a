#include <beltrami/differentials/hyperbolic_space.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/hyperbolic/face_chart.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/linear/element_system.h>

namespace beltrami {

namespace {

constexpr double kShift = 1e-2;  // of the eigenvalues, which makes the matrix definite
constexpr double kGap = 0.25;    // between the kernel and the rest
constexpr int kSpare = 2;        // vectors beside those wanted, which make them converge quickly
constexpr int kMostRounds = 12;
constexpr double kSettledAngle = 1e-10;  // of eigenvalues

/// ∂̄ of q on one face: Σ row_k q_k in the chart; what a value at a corner becomes there; and the area.
struct FaceOperator {
    std::array<Complex, 3> dbar, carry;
    Complex derivative;  // of the chart in the face's own frame
    double area;
};

std::vector<FaceOperator> face_operators(const Surface& source, const HyperbolicSurface& metric) {
    std::vector<FaceOperator> result(static_cast<std::size_t>(source.mesh.face_count()));
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const FaceChart chart(metric.step(3 * f), metric.step(3 * f + 2));
        const std::array<Complex, 3> w = chart.places();
        FaceOperator& face = result[static_cast<std::size_t>(f)];
        const double doubled = std::imag(std::conj(w[1] - w[0]) * (w[2] - w[0]));
        face.area = 2 * std::abs(doubled);  // four times that of the chart: the metric is 4 |dw|² there
        face.derivative = 0;
        const auto gradients = source.operators.gradient(f);
        for (std::size_t k = 0; k < 3; ++k) {
            // The gradient of a hat function is its opposite edge turned by a right angle, over twice the area.
            const Complex gradient = Complex(0, 1) * (w[(k + 2) % 3] - w[(k + 1) % 3]) / doubled;
            const Complex conj_a = std::conj(chart.frames[k].a);
            face.carry[k] = conj_a * conj_a * conj_a * conj_a;
            face.dbar[k] = 0.5 * gradient * face.carry[k];
            face.derivative += 0.5 * w[k] * std::conj(gradients[k]);
        }
    }
    return result;
}

/// Dᴴ A D + shift M over the vertices, as a real matrix of pairs; M is diagonal.
class DbarSystem {
  public:
    DbarSystem(const Surface& source, const std::vector<FaceOperator>& faces)
        : faces_(source.mesh.faces),
          mass_(Eigen::VectorXd::Zero(source.mesh.vertex_count())),
          system_(faces_.offsets(), faces_.vertices(), source.mesh.vertex_count(), 1, 2),
          operators_(faces) {
        for (int f = 0; f < faces_.size(); ++f) {
            const FaceOperator& face = faces[static_cast<std::size_t>(f)];
            for (const int v : faces_[f]) mass_[v] += face.area / 3;
            std::array<double, 21> lower{};
            std::size_t entry = 0;
            for (std::size_t i = 0; i < 3; ++i)
                for (int part = 0; part < 2; ++part)
                    for (std::size_t j = 0; j <= i; ++j) {
                        const Complex value = 0.25 * face.area * std::conj(face.dbar[i]) * face.dbar[j];
                        // [[Re, −Im], [Im, Re]]
                        lower[entry++] = part == 0 ? value.real() : value.imag();
                        if (j < i || part == 1) lower[entry++] = part == 0 ? -value.imag() : value.real();
                    }
            for (std::size_t i = 0; i < 3; ++i)
                if (source.topology.on_boundary[faces_[f][i]]) clear(lower, 2 * i + 1);
            system_.add(f, lower);
        }
        for (Eigen::Index v = 0; v < mass_.size(); ++v)
            for (int part = 0; part < 2; ++part)
                system_.add_to_diagonal(static_cast<int>(2 * v + part), mass_[v] > 0 ? kShift * mass_[v] : 1);
        system_.factorize();
    }

    /// (Dᴴ A D + shift M)⁻¹ M x; real at boundary vertices if x is.
    Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& x) const {
        Eigen::MatrixXd pairs(2 * x.rows(), x.cols());
        for (Eigen::Index v = 0; v < x.rows(); ++v) {
            pairs.row(2 * v) = mass_[v] * x.row(v).real();
            pairs.row(2 * v + 1) = mass_[v] * x.row(v).imag();
        }
        pairs = system_.solve(pairs);
        Eigen::MatrixXcd result(x.rows(), x.cols());
        for (Eigen::Index v = 0; v < x.rows(); ++v)
            for (Eigen::Index j = 0; j < x.cols(); ++j) result(v, j) = {pairs(2 * v, j), pairs(2 * v + 1, j)};
        return result;
    }
    Eigen::MatrixXcd mass_product(const Eigen::MatrixXcd& x) const { return x.adjoint() * mass_.asDiagonal() * x; }
    /// xᴴ Dᴴ A D x.
    Eigen::MatrixXcd energy_product(const Eigen::MatrixXcd& x) const {
        Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(x.cols(), x.cols());
        for (int f = 0; f < faces_.size(); ++f) {
            const FaceOperator& face = operators_[static_cast<std::size_t>(f)];
            Eigen::RowVectorXcd dbar = Eigen::RowVectorXcd::Zero(x.cols());
            for (std::size_t k = 0; k < 3; ++k) dbar += face.dbar[k] * x.row(faces_[f][k]);
            result += 0.25 * face.area * dbar.adjoint() * dbar;
        }
        return result;
    }

  private:
    /// Takes an unknown out of a lower triangle of six.
    static void clear(std::array<double, 21>& lower, std::size_t unknown) {
        for (std::size_t other = 0; other < 6; ++other) {
            const std::size_t row = std::max(unknown, other), column = std::min(unknown, other);
            lower[row * (row + 1) / 2 + column] = 0;
        }
    }

    const FaceList& faces_;
    Eigen::VectorXd mass_;
    ElementSystem system_;
    const std::vector<FaceOperator>& operators_;
};

/// Columns made orthonormal, by combinations with complex or with real coefficients.
Eigen::MatrixXcd orthonormal(const Eigen::MatrixXcd& columns, Coefficients coefficients) {
    if (coefficients == Coefficients::complex) return complex_qr(columns).Q;
    Eigen::MatrixXd pairs(2 * columns.rows(), columns.cols());
    pairs << columns.real(), columns.imag();
    pairs = orthonormal_columns(pairs);
    return pairs.topRows(columns.rows()) + Complex(0, 1) * pairs.bottomRows(columns.rows());
}

/// Eigenvalues and eigenvectors of a pencil; of its real part where only real combinations are wanted.
HermitianEigen pencil_eigen(const Eigen::MatrixXcd& energy, const Eigen::MatrixXcd& mass, Coefficients coefficients) {
    if (coefficients == Coefficients::complex) return hermitian_eigen(energy, mass);
    const SymmetricEigen real = symmetric_eigen(energy.real(), mass.real());
    return {real.values, real.vectors.cast<Complex>()};
}

/// Values in the faces' own frames, orthonormal in L² of the surface.
Eigen::MatrixXcd on_faces(const Surface& source, const std::vector<FaceOperator>& faces, const Eigen::MatrixXcd& x,
                          Coefficients coefficients) {
    Eigen::MatrixXcd values = Eigen::MatrixXcd::Zero(source.mesh.face_count(), x.cols());
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const FaceOperator& face = faces[static_cast<std::size_t>(f)];
        for (std::size_t k = 0; k < 3; ++k) values.row(f) += face.carry[k] / 3.0 * x.row(source.mesh.faces[f][k]);
        values.row(f) *= face.derivative * face.derivative;
    }
    const Eigen::VectorXd roots =
        Eigen::Map<const Eigen::VectorXd>(source.operators.weights.data(), values.rows()).cwiseSqrt();
    return roots.cwiseInverse().asDiagonal() * orthonormal(roots.asDiagonal() * values, coefficients);
}

Eigen::MatrixXcd random_start(Eigen::Index rows, Eigen::Index columns) {
    Random random(1);
    Eigen::MatrixXcd x(rows, columns);
    for (Eigen::Index j = 0; j < columns; ++j)
        for (Eigen::Index i = 0; i < rows; ++i) x(i, j) = {random.uniform(-1, 1), random.uniform(-1, 1)};
    return x;
}

}  // namespace

HyperbolicSpace hyperbolic_space(const Surface& source, const HyperbolicSurface& metric) {
    require_triangles(source);
    const int dimension = 3 * metric.genus - 3;
    const std::vector<FaceOperator> operators = face_operators(source, metric);
    const DbarSystem system(source, operators);
    const Coefficients coefficients = metric.has_boundary() ? Coefficients::real : Coefficients::complex;
    Eigen::MatrixXcd x = random_start(source.mesh.vertex_count(), dimension + kSpare);
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        for (const int v : loop) x.row(v) = x.row(v).real().cast<Complex>().eval();
    Eigen::VectorXd values = Eigen::VectorXd::Zero(x.cols());
    HyperbolicSpace result{TabulatedSpace(Eigen::MatrixXcd(source.operators.sample_count(), 0)), {}, 0, 0};
    for (int round = 0; round < kMostRounds; ++round) {
        x = system.inverse(x);
        result.solves += static_cast<int>(x.cols());
        const HermitianEigen ritz = pencil_eigen(system.energy_product(x), system.mass_product(x), coefficients);
        x = (x * ritz.vectors).eval();
        const double moved = (ritz.values - values).head(dimension).cwiseAbs().maxCoeff();
        values = ritz.values;
        if (round > 0 && moved < kSettledAngle) break;
    }
    result.kernel = values.head(dimension);
    result.next = values[dimension];
    if (!(result.kernel[dimension - 1] < kGap && result.next > kGap))
        throw Error(Cause::not_solved,
                    "holomorphic quadratic differentials cannot be told from others: eigenvalue " +
                        std::to_string(dimension) + " is " + std::to_string(result.kernel[dimension - 1]) +
                        " and the next one " + std::to_string(result.next) + ", not below and above 1/4",
                    "refine the mesh");
    result.space = TabulatedSpace(on_faces(source, operators, x.leftCols(dimension), coefficients), coefficients);
    return result;
}

}  // namespace beltrami
