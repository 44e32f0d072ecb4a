#include <beltrami/mesh/quad_split.h>

#include <Eigen/Geometry>
#include <algorithm>

#include <beltrami/plane/polygon.h>

namespace beltrami {

std::array<std::array<int, 3>, 2> split_quad(const std::array<Eigen::Vector3d, 4>& corners) {
    const std::array<Eigen::Vector3d, 2> diagonals = {corners[2] - corners[0], corners[3] - corners[1]};
    const std::array<double, 2> lengths = {diagonals[0].stableNorm(), diagonals[1].stableNorm()};
    const double unit = std::max(lengths[0], lengths[1]);  // keeps fourth powers of lengths from under- and overflow
    const auto folds = [&](int start) {
        const Eigen::Vector3d d = diagonals[start] / unit;
        const Eigen::Vector3d right = (corners[start + 1] - corners[start]) / unit;
        const Eigen::Vector3d left = (corners[(start + 3) % 4] - corners[start]) / unit;
        return right.cross(d).dot(d.cross(left)) < 0;
    };
    const bool first_folds = folds(0), second_folds = folds(1);
    const bool first = first_folds != second_folds ? second_folds : lengths[0] <= lengths[1];
    if (first) return {{{0, 1, 2}, {0, 2, 3}}};
    return {{{1, 2, 3}, {1, 3, 0}}};
}

std::array<std::array<int, 3>, 2> split_inside(const std::array<Complex, 4>& corners) {
    const Complex diagonal = corners[2] - corners[0];
    if (cross(diagonal, corners[1] - corners[0]) * cross(diagonal, corners[3] - corners[0]) < 0)
        return {{{0, 1, 2}, {2, 3, 0}}};
    return {{{1, 2, 3}, {3, 0, 1}}};
}

}  // namespace beltrami
