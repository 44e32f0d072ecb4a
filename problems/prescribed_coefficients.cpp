#include "problems/prescribed_coefficients.h"

#include <cmath>
#include <numbers>

#include <beltrami/linear/decomposition.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami::bench {

namespace {

constexpr int kDegree = 80, kPoints = 1000;

Complex stretch(Complex z, double k) {
    return z * std::exp(k * std::conj(z));
}

}  // namespace

Mesh disk_of_square(int levels) {
    Mesh mesh;
    mesh.positions.resize(5, 2);
    mesh.positions << 0, 0, 1, 0, 0, 1, -1, 0, 0, -1;
    for (const int v : {1, 2, 3, 4}) mesh.faces.add({0, v, v % 4 + 1});
    for (int level = 0; level < levels; ++level) {
        mesh = midpoint_subdivide(mesh).mesh;
        for (const std::vector<int>& loop : topology(mesh).boundary_loops)
            for (const int v : loop) mesh.positions.row(v).normalize();
    }
    return mesh;
}

/// Arnoldi's process makes the powers of ζ orthogonal on the curve; Re h = −log |ζ| = −k cos θ there by least squares.
DiskStretch::DiskStretch(double k) : k_(k), radius_(std::exp(std::abs(k))) {
    Eigen::VectorXcd zeta(kPoints);
    Eigen::VectorXd wanted(kPoints);
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2 * std::numbers::pi * i / kPoints;
        zeta[i] = stretch(std::polar(1.0, angle), k) / radius_;
        wanted[i] = -k * std::cos(angle);
    }
    Eigen::MatrixXcd basis = Eigen::MatrixXcd::Ones(kPoints, kDegree + 1);
    for (int j = 0; j < kDegree; ++j) {
        Eigen::VectorXcd next = zeta.cwiseProduct(basis.col(j));
        std::vector<Complex> row;
        for (int i = 0; i <= j; ++i) {
            row.push_back(basis.col(i).dot(next) / static_cast<double>(kPoints));
            next -= row.back() * basis.col(i);
        }
        row.emplace_back(next.norm() / std::sqrt(static_cast<double>(kPoints)));
        basis.col(j + 1) = next / row.back();
        recurrence_.push_back(std::move(row));
    }
    Eigen::MatrixXd parts(kPoints, 2 * kDegree + 1);
    parts << basis.real(), -basis.imag().rightCols(kDegree);
    const Eigen::VectorXd solution = least_squares(parts, wanted);
    for (int j = 0; j <= kDegree; ++j) coefficients_.emplace_back(solution[j], j == 0 ? 0.0 : solution[kDegree + j]);
    residual_ = (parts * solution - wanted).cwiseAbs().maxCoeff();
    one_ = onto_circle(1);
}

/// The orthogonal polynomials at a point.
std::vector<Complex> DiskStretch::values(Complex zeta) const {
    std::vector<Complex> result{1};
    for (const std::vector<Complex>& row : recurrence_) {
        Complex next = zeta / radius_ * result.back();
        for (std::size_t i = 0; i + 1 < row.size(); ++i) next -= row[i] * result[i];
        result.push_back(next / row.back());
    }
    return result;
}

Complex DiskStretch::onto_circle(Complex z) const {
    const Complex zeta = stretch(z, k_);
    const std::vector<Complex> basis = values(zeta);
    Complex h = 0;
    for (std::size_t j = 0; j < basis.size(); ++j) h += coefficients_[j] * basis[j];
    return zeta * std::exp(h);
}

Complex DiskStretch::operator()(Complex z) const {
    return onto_circle(z) / one_;
}

Positions stretched_sphere(const Positions& points, Complex mu) {
    Positions result = points;
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        if (points(v, 2) < -1 + 1e-12) continue;  // the south pole
        const Complex z = stereographic(points.row(v));
        result.row(v) = sphere_point((z + mu * std::conj(z)) / (1.0 + mu));
    }
    return result;
}

}  // namespace beltrami::bench
