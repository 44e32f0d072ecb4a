#include <beltrami/differentials/pulled_back.h>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

constexpr int kPointsPerChunk = 256;

}  // namespace

Eigen::MatrixXcd pulled_back(const ChartPoints& points, Eigen::Index functions,
                             const std::function<Eigen::MatrixXcd(const Eigen::VectorXcd&)>& values) {
    Eigen::MatrixXcd result(points.positions.size(), functions);
    parallel_for(
        0, static_cast<int>(points.positions.size()),
        [&](int begin, int end) {
            const int count = end - begin;
            const Eigen::VectorXcd squares = points.derivatives.segment(begin, count).array().square();
            result.middleRows(begin, count) = squares.asDiagonal() * values(points.positions.segment(begin, count));
        },
        kPointsPerChunk);
    return result;
}

}  // namespace beltrami
