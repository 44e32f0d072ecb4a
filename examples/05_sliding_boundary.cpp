// The extremal map of an annulus onto another one, whose boundary slides along the circles: K* = log .3 / log .5.
#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdio>

int main() {
    using beltrami::TargetCurve;
    const beltrami::Surface source(beltrami::annulus(0.5, 1, 120));
    const beltrami::TargetDomain target =
        beltrami::target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0, 0.3)});
    const beltrami::ExtremalMap map = beltrami::extremal_map(source, target);
    std::printf("K = %.5f, exact %.5f; %zu loops slide, %zu faces flipped\n", map.K, std::log(0.3) / std::log(0.5),
                map.loops.size(), map.distortion.flipped.size());
}
