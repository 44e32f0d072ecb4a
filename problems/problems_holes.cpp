// Multiply connected problems in the plane.
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/operators/distortion.h>

#include "problems/construct.h"

namespace beltrami::bench {

namespace {

Mesh disk_with_holes(const std::vector<Circle>& holes, double edge_length, double hole_edge_length = 0) {
    DomainOptions options;
    options.edge_length = edge_length;
    options.hole_edge_length = hole_edge_length;
    return circle_domain({}, holes, options);
}

/// Radii r0 … 1 at even shape: edges are as long as the size wants at the outer rim, shorter inside.
Mesh round_annulus(double inner, double edge_length) {
    return annulus(inner, 1, std::max(8, static_cast<int>(std::lround(2 * kPi / edge_length))));
}

}  // namespace

Problem ring(double edge_length) {
    const double K = std::log(0.3) / std::log(0.5);
    return with_exact_map(
        "ring", "The ring .5 < |z| < 1 to .3 < |w| < 1, boundary values along the radii",
        round_annulus(0.5, edge_length), [=](Complex z) { return z * std::pow(std::abs(z), K - 1); }, k_of(K));
}

// In log z the map is linear, [[κ, 0], [s, 1]] on (log r, angle), and s turns the inner circle by s·log(r0).
Problem annulus_turns(double edge_length, int turns) {
    const double r0 = 0.05, kappa = 1.5, s = 2 * kPi * turns / std::log(r0);
    const double sum = kappa * kappa + s * s + 1, root = std::sqrt(sum * sum - 4 * kappa * kappa);
    const double K = (sum + root) / (2 * kappa);  // σmax/σmin = σmax²/det
    Problem problem = with_exact_map(
        "annulus",
        "The annulus .05 < |z| < 1 to .0112 < |w| < 1, r → r^1.5, the inner circle " + std::to_string(turns) +
            " turns ahead of the outer one",
        round_annulus(r0, edge_length),
        [=](Complex z) {
            const double log_r = std::log(std::abs(z));
            return std::polar(std::exp(kappa * log_r), std::arg(z) + s * log_r);
        },
        k_of(K));
    problem.turns = {0, turns};
    return problem;
}

Problem annulus_stretch(double edge_length) {
    Problem problem = annulus_turns(edge_length, 0);
    problem.name = "annulus_stretch";
    return problem;
}
Problem annulus_one_turn(double edge_length) {
    Problem problem = annulus_turns(edge_length, 1);
    problem.name = "annulus_one_turn";
    return problem;
}
Problem annulus_minus_one_turn(double edge_length) {
    Problem problem = annulus_turns(edge_length, -1);
    problem.name = "annulus_minus_one_turn";
    return problem;
}
Problem annulus_two_turns(double edge_length) {
    Problem problem = annulus_turns(edge_length, 2);
    problem.name = "annulus_two_turns";
    return problem;
}

Problem moved_hole(double edge_length) {
    // Scaled and turned about 0 within the hole's circle, then moved: a homeomorphism of the disk that keeps its
    // circle.
    const Complex target(0.3, 0.15);
    return with_homeomorphism(
        "moved_hole", "The annulus .4 < |z| < 1, its hole shrunk to radius .25, turned by 1 radian and moved by .34",
        disk_with_holes({{{0, 0}, 0.4}}, edge_length), [=](Complex z) {
            const double r = std::abs(z), t = (r - 0.4) / 0.6;
            const Complex w = z / r * (0.25 + 0.75 * t) * std::polar(1.0, 1 - t);
            return w + (1 - t) * target;
        });
}

Problem ring_to_lobes(double edge_length) {
    return with_homeomorphism(
        "ring_to_lobes",
        "The annulus .35 < |z| < 1, outer circle to an oval, inner one to three lobes, at uneven speed",
        disk_with_holes({{{0, 0}, 0.35}}, edge_length), [](Complex z) {
            const double r = std::abs(z), t = (r - 0.35) / 0.65, a = std::arg(z);
            const Complex inner = std::polar(0.32 * (1 + 0.3 * std::cos(3 * a)), a + 0.25 * std::sin(3 * a)),
                          outer = [&] {
                              const Complex w = std::polar(1.0, a + 0.3 * std::sin(2 * a));
                              return Complex(1.3 * w.real(), 0.85 * w.imag());
                          }();
            return (1 - t) * inner + t * outer;
        });
}

Problem doughnut(double edge_length) {
    return with_homeomorphism(
        "doughnut", "The annulus .4 < |z| < 1, its hole widened to radius .65 and moved by .2; the outer circle stays",
        disk_with_holes({{{0, 0}, 0.4}}, edge_length), [](Complex z) {
            const double r = std::abs(z), t = (r - 0.4) / 0.6;
            return z / r * (0.65 + 0.35 * t) + (1 - t) * 0.2;
        });
}

Problem holes_27(double edge_length) {
    std::vector<Circle> holes;
    for (int row = 0; row < 5; ++row) {
        const int count = row % 2 == 0 ? 5 : 6;
        for (int i = 0; i < count; ++i)
            holes.push_back({{0.3 * (i - (count - 1) / 2.0), 0.27 * (row - 2)}, 0.055 + 0.01 * ((row + i) % 3)});
    }
    std::vector<PlaneMap> steps;
    for (std::size_t i = 0; i < holes.size(); ++i) {
        const Complex centre(holes[i].centre.x(), holes[i].centre.y());
        steps.push_back(rigid_turn(centre, i % 2 == 0 ? 0.35 : -0.35, holes[i].radius, 0.13));
        steps.push_back(rigid_scale(centre, i % 3 == 0 ? 1.25 : 0.7, holes[i].radius, 0.13));
    }
    steps.push_back(shear_wave(0.0, 0.15, 3, 0));
    return with_homeomorphism("holes_27", "A disk with 27 round holes, each turned and shrunk or widened, then sheared",
                              disk_with_holes(holes, edge_length, edge_length / 2), composition(steps));
}

}  // namespace beltrami::bench
