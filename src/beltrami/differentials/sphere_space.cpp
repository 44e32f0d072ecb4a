#include <beltrami/differentials/sphere_space.h>

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include <beltrami/base/parallel.h>
#include <beltrami/sphere/atlas.h>

namespace beltrami {

namespace {

constexpr int kPasses = 8;  // in which ρ follows the basis

/// Three landmarks far apart, then the others.
std::vector<int> spread_order(const Positions& landmarks) {
    const auto n = static_cast<int>(landmarks.rows());
    std::vector<int> order{0};
    for (int next = 1; next < std::min(n, 3); ++next) {
        int farthest = 0;
        double most = -1;
        for (int i = 0; i < n; ++i) {
            double nearest = 4;
            for (const int o : order) nearest = std::min(nearest, (landmarks.row(i) - landmarks.row(o)).norm());
            if (nearest > most) most = nearest, farthest = i;
        }
        order.push_back(farthest);
    }
    for (int i = 0; i < n; ++i)
        if (std::find(order.begin(), order.begin() + std::min(n, 3), i) == order.begin() + std::min(n, 3))
            order.push_back(i);
    return order;
}

/// Values at all points of the quadrature, with their weights: the samples, and in place of some their points.
struct Quadrature {
    Eigen::MatrixXcd values;
    Eigen::VectorXd weights;
};

Quadrature quadrature(const SphereSpace& space, const Surface& source, const Chart& chart, const SamplePoints& means) {
    const Eigen::Index samples = chart.positions.size(), points = means.weights.size();
    const std::vector<double>& areas = source.operators.weights;
    Quadrature result{Eigen::MatrixXcd(samples + points, space.size()), Eigen::VectorXd(samples + points)};
    result.values.topRows(samples) = space.generators({chart.positions, chart.derivatives});
    if (points > 0) result.values.bottomRows(points) = space.generators(means.points);
    for (Eigen::Index s = 0; s < samples; ++s) result.weights[s] = chart.excluded[s] ? 0 : areas[s];
    for (Eigen::Index i = 0; i < points; ++i) {
        const int s = means.samples[i];
        result.weights[samples + i] = chart.excluded[s] ? 0 : means.weights[i] * areas[s];
    }
    for (const int s : means.samples) result.weights[s] = 0;
    // A sample that is left out may lie on a pole.
    for (Eigen::Index i = 0; i < result.weights.size(); ++i)
        if (result.weights[i] == 0) result.values.row(i).setZero();
    return result;
}

/// T for which the columns of values T are orthonormal, see SphereSpace.
Eigen::MatrixXcd orthonormalizing(Quadrature q) {
    const Eigen::Index m = q.values.cols();
    Eigen::MatrixXcd transform = Eigen::MatrixXcd::Identity(m, m);
    const auto apply = [&](const Eigen::MatrixXcd& step) {
        q.values = q.values * step;
        transform = transform * step;
    };
    const Eigen::VectorXd sizes = q.values.cwiseAbs().transpose() * q.weights;
    apply(Eigen::MatrixXcd(sizes.cwiseInverse().cast<Complex>().asDiagonal()));
    for (int pass = 0; pass < kPasses; ++pass) {
        const Eigen::VectorXd rho = q.values.cwiseAbs().rowwise().sum();
        Eigen::MatrixXcd scaled = q.values;
        for (Eigen::Index i = 0; i < scaled.rows(); ++i)
            scaled.row(i) *= rho[i] > 0 ? std::sqrt(q.weights[i] / rho[i]) : 0.0;
        const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(scaled);
        const Eigen::MatrixXcd upper = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
        apply(upper.triangularView<Eigen::Upper>().solve(Eigen::MatrixXcd::Identity(m, m)));
    }
    return transform;
}

}  // namespace

SphereSpace::SphereSpace(const Surface& source, const Chart& chart, const Positions& landmarks,
                         const SamplePoints& means)
    : order_(spread_order(landmarks)) {
    for (Eigen::Index i = 0; i < landmarks.rows(); ++i) spinors_.push_back(atlas::unit_spinor(landmarks.row(i)));
    transform_ = orthonormalizing(quadrature(*this, source, chart, means));
}

Eigen::MatrixXcd SphereSpace::generators(const ChartPoints& points) const {
    Eigen::MatrixXcd values(points.positions.size(), size());
    parallel_for(0, static_cast<int>(values.rows()), [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const auto [xi, eta] = atlas::spinor(points.positions[i]);
            const auto factor = [&, a = xi, b = eta](int landmark) {
                const auto& [u, v] = spinors_[order_[landmark]];
                return a * v - u * b;
            };
            const Complex common = points.derivatives[i] * points.derivatives[i] / (factor(0) * factor(1) * factor(2));
            for (int j = 0; j < size(); ++j) values(i, j) = common / factor(3 + j);
        }
    });
    return values;
}

}  // namespace beltrami
