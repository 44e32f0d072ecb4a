#include <beltrami/differentials/singularities.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

CellSize::CellSize(double largest, const Singularities& singularities, double slope, double hole_slope, double least)
    : largest_(largest), deepest_(std::max(0, static_cast<int>(std::ceil(std::log2(largest / least))))) {
    for (const auto& hole : singularities.holes) centres_.push_back({hole.centre, hole_slope * hole_slope});
    for (const auto& corner : singularities.corners) centres_.push_back({corner.vertex, slope * slope});
    for (const Complex pin : singularities.pins) centres_.push_back({pin, slope * slope});
}

int CellSize::level(Complex z) const {
    double square = largest_ * largest_;
    for (const Centre& centre : centres_) square = std::min(square, centre.squared_slope * std::norm(z - centre.at));
    if (square >= largest_ * largest_) return 0;
    if (!(square > 0)) return deepest_;
    return std::min(deepest_, static_cast<int>(std::ceil(0.5 * std::log2(largest_ * largest_ / square))));
}

}  // namespace beltrami
