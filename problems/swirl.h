// The swirls of Ng, Gu and Lui's Example 3, and domains that maps of circle domains have as images.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <beltrami/targets/target_domain.h>

namespace beltrami::bench {

/// The paper's map, eq. (37): f = e^{1.5i} z e^{1.5i|z|}.
inline Complex swirl(Complex z) {
    return std::polar(1.0, 1.5) * z * std::polar(1.0, 1.5 * std::abs(z));
}

/// Its coefficient: ∂̄|z| = z/2|z| and ∂|z| = z̄/2|z| give μ = ¾i z²/(|z| + ¾i |z|²). Eq. (38) has −¾i in both places,
/// which is that of z e^{−1.5i|z|}.
inline Complex swirl_coefficient(Complex z) {
    const Complex c(0, 0.75);
    const double r = std::abs(z);
    return c * z * z / (r + c * r * r);
}

/// The domain between the images of the unit circle and of round holes: splines through many exact points.
/// @param holes each with x, y and radius
template <class Holes, class Map>
TargetDomain image_domain(const Holes& holes, const Map& f) {
    const auto image = [&](Complex centre, double radius) {
        std::vector<Complex> points;
        for (int i = 0; i < 500; ++i) points.push_back(f(centre + std::polar(radius, 2 * std::numbers::pi * i / 500)));
        return TargetCurve::spline(points);
    };
    std::vector<TargetCurve> curves;
    for (const auto& [x, y, r] : holes) curves.push_back(image({x, y}, r));
    return target_domain(image(0, 1), std::move(curves));
}

}  // namespace beltrami::bench
