#include <beltrami/plane/disk_moebius.h>

#include <cmath>

namespace beltrami {

Complex DiskMoebius::operator()(Complex z) const {
    return std::polar(1.0, rotation) * (z - centre) / (1.0 - std::conj(centre) * z);
}

Eigen::VectorXcd DiskMoebius::operator()(const Eigen::VectorXcd& places) const {
    return places.unaryExpr([&](const Complex& z) { return (*this)(z); });
}

RoundHole DiskMoebius::operator()(const RoundHole& hole) const {
    // A circle is sent to that of the same hyperbolic radius around the image of its hyperbolic centre.
    const HyperbolicCircle circle = hyperbolic_circle(hole);
    const Complex at = (*this)(circle.centre);
    const double p = std::norm(at), r = std::tanh(circle.radius / 2), scale = 1 - p * r * r;
    return {hole.loop, at * ((1 - r * r) / scale), r * (1 - p) / scale};
}

HyperbolicCircle hyperbolic_circle(const RoundHole& hole) {
    const double away = std::abs(hole.centre);
    const double far = std::atanh(away + hole.radius), near = std::atanh(away - hole.radius);
    const Complex direction = away > 0 ? hole.centre / away : Complex(1);
    return {std::tanh((far + near) / 2) * direction, far - near};
}

double hyperbolic_gap(Complex z, Complex w) {
    return std::norm(z - w) / ((1 - std::norm(z)) * (1 - std::norm(w)));
}

DiskMoebius centring(const RoundHole& hole) {
    return {0, hyperbolic_circle(hole).centre};
}

}  // namespace beltrami
