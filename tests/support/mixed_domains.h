#pragma once

#include <complex>
#include <numbers>
#include <vector>

#include <beltrami/differentials/mixed_domain.h>

namespace beltrami::test {

/// A circle of a circle domain with one condition all around.
inline MixedDomain::Loop whole_circle(Complex centre, double radius, bool slides) {
    return {centre, radius, {{centre, radius, 0, 2 * std::numbers::pi, 0, 0, slides, false, false}}, {}};
}

/// The unit disk, sliding on arcs [ends[0], ends[1]], [ends[2], ends[3]] …, prescribed between them.
inline MixedDomain disk_with_sliding_arcs(const std::vector<double>& ends) {
    MixedDomain domain{{{0, 1, {}, {}}}, {}, {}, {}};
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const double to = i + 1 < ends.size() ? ends[i + 1] : ends[0] + 2 * std::numbers::pi;
        domain.loops[0].parts.push_back({0, 1, ends[i], to, 0, 0, i % 2 == 0, true, true});
        domain.loops[0].transitions.push_back(std::polar(1.0, ends[i]));
    }
    return domain;
}

}  // namespace beltrami::test
