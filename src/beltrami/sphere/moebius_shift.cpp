#include <beltrami/sphere/moebius_shift.h>

namespace beltrami {

Positions moebius_shifted(const Positions& points, const Eigen::RowVector3d& c) {
    Positions result(points.rows(), 3);
    const double factor = 1 - c.squaredNorm();
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        const Eigen::RowVector3d d = points.row(v) + c;
        result.row(v) = (factor / d.squaredNorm() * d + c).normalized();
    }
    return result;
}

}  // namespace beltrami
