#include <beltrami/targets/target.h>

#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

constexpr int kGrain = 256;  // points of a chunk: finding the nearest is dear

Positions rows_of(const Target::Points& points, Eigen::Vector3d Target::Point::*of) {
    Positions result(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = points[i].*of;
    return result;
}

}  // namespace

Target::Points nearest_points(const Target& target, const Positions& points) {
    std::vector<int> infinite;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        if (!points.row(i).allFinite()) infinite.push_back(static_cast<int>(i));
    if (!infinite.empty()) {
        const std::string first = "point " + std::to_string(infinite[0]);
        throw Error(Cause::bad_option, first + " is not finite", {}, {Things::points, std::move(infinite)});
    }
    Target::Points result(static_cast<std::size_t>(points.rows()));
    parallel_for(
        0, static_cast<int>(points.rows()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i)
                result[i] = target.nearest({points(i, 0), points(i, 1), points.cols() > 2 ? points(i, 2) : 0.0});
        },
        kGrain);
    return result;
}

Positions positions_of(const Target::Points& points) {
    return rows_of(points, &Target::Point::position);
}

Positions normals_of(const Target::Points& points) {
    return rows_of(points, &Target::Point::normal);
}

}  // namespace beltrami
