#include "problems/outlines.h"

#include <cmath>

#include <beltrami/base/constants.h>

namespace beltrami::bench {

namespace {

Eigen::Vector2d polar(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

Polygon gear(int teeth, double root_radius, double outer_radius) {
    Polygon result;
    for (int t = 0; t < teeth; ++t) {
        const double pitch = 2 * kPi / teeth, middle = t * pitch;
        result.push_back(polar(outer_radius, middle - 0.17 * pitch));
        result.push_back(polar(outer_radius, middle + 0.17 * pitch));
        result.push_back(polar(root_radius, middle + 0.28 * pitch));
        result.push_back(polar(root_radius, middle + 0.72 * pitch));
    }
    return result;
}

Polygon notched_circle(int notches, double width, double tip_radius, int corner_count) {
    Polygon result;
    const double pitch = 2 * kPi / notches, half = std::asin(width / 2);
    const int per_arc = corner_count / notches;
    for (int n = 0; n < notches; ++n) {
        const double middle = n * pitch;
        result.push_back(polar(1, middle - half));
        result.push_back(polar(tip_radius, middle));
        for (int i = 0; i < per_arc; ++i) result.push_back(polar(1, middle + half + (pitch - 2 * half) * i / per_arc));
    }
    return result;
}

Polygon regular(int corners, Eigen::Vector2d centre, double radius, double angle) {
    Polygon result;
    for (int i = 0; i < corners; ++i) result.push_back(centre + polar(radius, angle + 2 * kPi * i / corners));
    return result;
}

}  // namespace beltrami::bench
