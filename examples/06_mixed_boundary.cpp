// Boundary conditions that mix: a square whose left and right sides are prescribed while the upper and lower ones
// slide. z ↦ 2 Re z + i Im z is extremal, K* = 2.
#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const int n = 24;
    const beltrami::Surface source(beltrami::rectangle(1, 1, n, n));
    const auto vertex = [&](int i, int j) { return j * (n + 1) + i; };
    beltrami::Constraints constraints;
    for (int j = 0; j <= n; ++j)
        for (const int i : {0, n}) constraints.pin(vertex(i, j), beltrami::Complex(i == 0 ? 0 : 2, 1.0 * j / n));
    // Arcs run along the loop, which has the surface on its left; their ends stay prescribed.
    const auto rectangle = beltrami::TargetCurve::polygon({0, 2, {2, 1}, {0, 1}});
    constraints.slide(vertex(0, 0), vertex(n, 0), rectangle).slide(vertex(n, n), vertex(0, n), rectangle);
    const beltrami::ExtremalMap map = beltrami::extremal_map(source, constraints);
    std::printf("K = %.4f, largest K of a face %.4f, %zu faces flipped\n", map.K, map.K_max,
                map.distortion.flipped.size());
}
