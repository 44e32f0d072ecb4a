// The extremal map of a mesh of quads: every quad has four samples, and nothing else changes.
#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const beltrami::Surface source(beltrami::rectangle(1, 1, 30, 30, beltrami::Cells::quads));
    const beltrami::ExtremalMap map =
        beltrami::extremal_map(source, beltrami::boundary_to_rectangle(source, 2, 1, std::nullopt));
    std::printf("%d quads, %d samples: K = %.4f, %zu faces flipped\n", source.mesh.face_count(),
                source.operators.sample_count(), map.K, map.distortion.flipped.size());
}
