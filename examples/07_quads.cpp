// The extremal map of a mesh of quads: every quad has four samples, and nothing else changes.
#include <beltrami/beltrami.h>

#include <array>
#include <cstdio>

int main() {
    const int n = 30;
    const beltrami::Surface source(beltrami::rectangle(1, 1, n, n, beltrami::Cells::quads));
    const std::array<int, 4> corners{0, n, (n + 1) * (n + 1) - 1, n * (n + 1)};
    const beltrami::ExtremalMap map =
        beltrami::extremal_map(source, beltrami::boundary_to_rectangle(source, 2, 1, corners));
    std::printf("%d quads, %d samples: K = %.4f, %zu faces flipped\n", source.mesh.face_count(),
                source.operators.sample_count(), map.K, map.distortion.flipped.size());
}
