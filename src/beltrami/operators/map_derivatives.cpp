#include <beltrami/operators/map_derivatives.h>

#include <Eigen/Geometry>
#include <algorithm>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// (∂f, ∂̄f) of a map into space, in an orthonormal frame of the image oriented by the image's vertex normals.
std::array<Complex, 2> derivatives_in_space(const Operators& source, int sample, const Positions& image,
                                            const Positions& normals) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), y = x, up = x;
    const auto stencil = source.stencil(sample);
    const auto gradient = source.gradient(sample);
    const Eigen::RowVector3d base = image.row(stencil[0]);
    for (std::size_t j = 0; j < stencil.size(); ++j) {
        const Eigen::Vector3d p = image.row(stencil[j]) - base;
        x += gradient[j].real() * p;
        y += gradient[j].imag() * p;
        up += normals.row(stencil[j]);
    }
    const Eigen::Vector3d normal = x.cross(y);
    const double side = normal.dot(up) < 0 ? -1.0 : 1.0;
    const Eigen::Vector3d& axis = x.squaredNorm() >= y.squaredNorm() ? x : y;
    if (axis.squaredNorm() == 0) return {0.0, 0.0};
    const Eigen::Vector3d e1 = axis.normalized();
    // In the plane of x and y; where they are parallel the second coordinate is 0 whatever e2 is.
    Eigen::Vector3d e2 = normal.cross(e1);
    if (e2.squaredNorm() > 0) e2.normalize();
    e2 *= side;
    const Complex fx(x.dot(e1), x.dot(e2)), fy(y.dot(e1), y.dot(e2)), i(0, 1);
    return {0.5 * (fx - i * fy), 0.5 * (fx + i * fy)};
}

template <class AtSample>
MapDerivatives collect(const Operators& source, double image_diameter, AtSample&& at_sample) {
    MapDerivatives result{Eigen::VectorXcd(source.sample_count()), Eigen::VectorXcd(source.sample_count()),
                          image_diameter};
    parallel_for(0, source.sample_count(), [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const auto [d_z, d_zbar] = at_sample(s);
            result.dz[s] = d_z;
            result.dzbar[s] = d_zbar;
        }
    });
    return result;
}

}  // namespace

MapDerivatives derivatives(const Operators& source, const Eigen::VectorXcd& map) {
    double x0 = kInfinity, x1 = -kInfinity, y0 = kInfinity, y1 = -kInfinity;
    for (const int v : source.vertices) {
        x0 = std::min(x0, map[v].real());
        x1 = std::max(x1, map[v].real());
        y0 = std::min(y0, map[v].imag());
        y1 = std::max(y1, map[v].imag());
    }
    return collect(source, std::abs(Complex(x1 - x0, y1 - y0)), [&](int s) { return source.derivatives(s, map); });
}

MapDerivatives derivatives(const Operators& source, const Positions& image, const Positions& normals) {
    Eigen::RowVector3d low = Eigen::RowVector3d::Constant(kInfinity), high = -low;
    for (const int v : source.vertices) {
        low = low.cwiseMin(image.row(v));
        high = high.cwiseMax(image.row(v));
    }
    return collect(source, (high - low).norm(), [&](int s) { return derivatives_in_space(source, s, image, normals); });
}

}  // namespace beltrami
