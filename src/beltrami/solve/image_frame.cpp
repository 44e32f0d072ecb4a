#include <beltrami/solve/image_frame.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace beltrami {

ImageFrame image_frame(const Operators& operators, int sample, const Positions& points, const Positions& normals) {
    const auto stencil = operators.stencil(sample);
    const auto gradient = operators.gradient(sample);
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), y = x, up = x;
    const Eigen::Vector3d base = points.row(stencil[0]);
    for (std::size_t j = 0; j < stencil.size(); ++j) {
        const Eigen::Vector3d point = points.row(stencil[j]);
        x += gradient[j].real() * (point - base);
        y += gradient[j].imag() * (point - base);
        up += normals.row(stencil[j]);
    }
    ImageFrame frame;
    const Eigen::Vector3d normal = x.cross(y);
    frame.upright = normal.dot(up) > 0;
    frame.e1 = (x.squaredNorm() >= y.squaredNorm() ? x : y).normalized();
    frame.e2 = normal.cross(frame.e1).normalized();
    if (!frame.upright) frame.e2 = -frame.e2;
    const Complex fx = frame.along(x), fy = frame.along(y), i(0, 1);
    frame.p = 0.5 * (fx - i * fy);
    frame.q = 0.5 * (fx + i * fy);
    return frame;
}

Eigen::VectorXd local_sizes(const Operators& operators, const Positions& points) {
    Eigen::VectorXd sizes = Eigen::VectorXd::Constant(operators.vertex_count, std::numeric_limits<double>::infinity());
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        double longest = 0;
        for (std::size_t j = 0; j < stencil.size(); ++j)
            longest =
                std::max(longest, (points.row(stencil[(j + 1) % stencil.size()]) - points.row(stencil[j])).norm());
        for (const int v : stencil) sizes[v] = std::min(sizes[v], longest);
    }
    for (double& size : sizes) size = std::isfinite(size) ? std::max(size, 1e-300) : 1;
    return sizes;
}

}  // namespace beltrami
