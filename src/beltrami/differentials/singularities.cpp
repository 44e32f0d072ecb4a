#include <beltrami/differentials/singularities.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

CellSize::CellSize(double largest, const Singularities& singularities, double slope, double hole_slope, double least)
    : largest_(largest), deepest_(std::max(0, static_cast<int>(std::ceil(std::log2(largest / least))))) {
    for (const auto& hole : singularities.holes) centres_.push_back({hole.centre, hole_slope * hole_slope});
    for (const auto& corner : singularities.corners) centres_.push_back({corner.vertex, slope * slope});
    for (const Complex pin : singularities.pins) centres_.push_back({pin, slope * slope});
    for (const auto& held : singularities.held) centres_.push_back({held.at, slope * slope});
    squared_slope_ = slope * slope;
    for (const auto& curve : singularities.curves)
        for (int i = curve.first; i < curve.last; ++i) edges_.push_back({curve.points[i], curve.points[i + 1]});
}

void CellSize::shrink_towards_circle(double slope, double least) {
    circle_slope_ = slope;
    least_at_circle_ = least;
    deepest_ = std::max(deepest_, static_cast<int>(std::ceil(std::log2(largest_ / least))));
}

namespace {

double squared_distance(Complex z, const std::array<Complex, 2>& edge) {
    const Complex along = edge[1] - edge[0], from = z - edge[0];
    const double length = std::norm(along);
    const double t = length > 0 ? std::clamp(std::real(from * std::conj(along)) / length, 0.0, 1.0) : 0.0;
    return std::norm(from - t * along);
}

}  // namespace

int CellSize::level(Complex z) const {
    double square = largest_ * largest_;
    for (const Centre& centre : centres_) square = std::min(square, centre.squared_slope * std::norm(z - centre.at));
    for (const auto& edge : edges_) square = std::min(square, squared_slope_ * squared_distance(z, edge));
    if (circle_slope_ > 0) {
        const double size = std::max(circle_slope_ * (1 - std::abs(z)), least_at_circle_);
        square = std::min(square, size * size);
    }
    if (square >= largest_ * largest_) return 0;
    if (!(square > 0)) return deepest_;
    return std::min(deepest_, static_cast<int>(std::ceil(0.5 * std::log2(largest_ * largest_ / square))));
}

}  // namespace beltrami
