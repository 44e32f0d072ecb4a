#include "problems/homeomorphism.h"

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>

namespace beltrami::bench {

namespace {

/// 1 up to inner, 0 from outer on, a cubic with flat ends in between.
double plateau(double r, double inner, double outer) {
    const double t = std::clamp((r - inner) / (outer - inner), 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

}  // namespace

PlaneMap affine_stretch(double amount, double direction) {
    const Complex b = std::sinh(amount) * std::polar(1.0, 2 * direction);
    return [a = std::cosh(amount), b](Complex z) { return a * z + b * std::conj(z); };
}

PlaneMap radial_power(Complex centre, double exponent, double core) {
    return [=](Complex z) {
        const Complex d = z - centre;
        return centre + d * std::pow(std::norm(d) + core * core, (exponent - 1) / 2);
    };
}

PlaneMap radial_swell(Complex centre, double amount, double width) {
    return [=](Complex z) {
        const Complex d = z - centre;
        return centre + d * (1 + amount * std::exp(-std::norm(d) / (width * width)));
    };
}

PlaneMap twist(Complex centre, double angle, double width) {
    return [=](Complex z) {
        const Complex d = z - centre;
        return centre + d * std::polar(1.0, angle * std::exp(-std::norm(d) / (width * width)));
    };
}

PlaneMap rigid_turn(Complex centre, double angle, double inner, double outer) {
    return [=](Complex z) {
        const Complex d = z - centre;
        return centre + d * std::polar(1.0, angle * plateau(std::abs(d), inner, outer));
    };
}

PlaneMap rigid_scale(Complex centre, double factor, double inner, double outer) {
    // Beyond the inner radius, radii are linear between those of the two circles.
    return [=](Complex z) {
        const Complex d = z - centre;
        const double r = std::abs(d);
        if (r >= outer) return z;
        if (r <= inner) return centre + factor * d;
        const double image = outer - (outer - r) * (outer - factor * inner) / (outer - inner);
        return centre + d * (image / r);
    };
}

PlaneMap spiral(Complex centre, double amount, double core) {
    return [=](Complex z) {
        const Complex d = z - centre;
        return centre + d * std::polar(1.0, amount / 2 * std::log(std::norm(d) + core * core));
    };
}

PlaneMap shear_wave(double direction, double amplitude, double frequency, double phase) {
    return [=, along = std::polar(1.0, direction)](Complex z) {
        const double across = std::imag(z * std::conj(along));
        return z + along * (amplitude * std::sin(frequency * across + phase));
    };
}

PlaneMap squeeze(double direction, double amount, double frequency, double phase) {
    return [=, along = std::polar(1.0, direction)](Complex z) {
        const double x = std::real(z * std::conj(along));
        return z + along * (amount / frequency * std::sin(frequency * x + phase));
    };
}

PlaneMap composition(std::vector<PlaneMap> steps) {
    return [steps = std::move(steps)](Complex z) {
        for (const auto& step : steps) z = step(z);
        return z;
    };
}

std::function<PlaneMap(double)> random_homeomorphisms(Random& random, const std::vector<Complex>& centres) {
    std::vector<std::function<PlaneMap(double)>> families;
    const auto sign = [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
    const auto angle = [&] { return random.uniform(-kPi, kPi); };
    const int steps = 2 + static_cast<int>(random.next() % 4);
    for (int i = 0; i < steps; ++i) {
        // Drawn one after the other, in an order that the language fixes.
        const std::uint64_t kind = random.next() % 7;
        const double amount = sign() * random.uniform(0.4, 1.2), a = angle(), b = random.uniform(0.25, 0.8),
                     frequency = random.uniform(1.5, 5), x = random.uniform(-0.7, 0.7), y = random.uniform(-0.7, 0.7);
        const std::uint64_t pick = random.next();
        const bool about_hole = !centres.empty() && pick % 3 != 0;
        const Complex centre = about_hole ? centres[pick / 3 % centres.size()] : Complex(x, y);
        families.push_back([=](double s) -> PlaneMap {
            switch (kind) {
                case 0:
                    return affine_stretch(0.6 * s * amount, a);
                case 1:
                    return radial_power(centre, std::exp(s * amount), b);
                case 2:
                    return radial_swell(centre, amount < 0 ? std::tanh(s * amount) * 0.9 : std::min(2.0, s * amount),
                                        b);
                case 3:
                    return twist(centre, 1.5 * s * amount, b);
                case 4:
                    return spiral(centre, s * amount, b / 4);
                case 5:
                    return shear_wave(a, s * amount / frequency, frequency, 7 * x);
                default:
                    return squeeze(a, 0.95 * std::tanh(s * amount), frequency, 7 * x);
            }
        });
    }
    return [families = std::move(families)](double strength) {
        std::vector<PlaneMap> maps;
        for (const auto& family : families) maps.push_back(family(strength));
        return composition(std::move(maps));
    };
}

}  // namespace beltrami::bench
