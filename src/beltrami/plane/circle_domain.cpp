#include <beltrami/plane/circle_domain.h>

#include <algorithm>

namespace beltrami {

double least_gap(std::span<const RoundHole> holes) {
    double least = 1;
    for (std::size_t i = 0; i < holes.size(); ++i) {
        const RoundHole& a = holes[i];
        least = std::min(least, (1 - std::abs(a.centre) - a.radius) / a.radius);
        for (std::size_t j = 0; j < i; ++j) {
            const RoundHole& b = holes[j];
            const double gap = std::abs(a.centre - b.centre) - a.radius - b.radius;
            least = std::min(least, gap / std::min(a.radius, b.radius));
        }
    }
    return least;
}

}  // namespace beltrami
