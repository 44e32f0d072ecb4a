#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const beltrami::Surface surface(beltrami::disk(beltrami::disk_rings_for_triangles(1000)));
    const beltrami::ExtremalMap map = beltrami::extremal_map(surface, beltrami::boundary_to_disk(surface, 0.5));
    std::printf("beltrami %s: K = %.3f\n", BELTRAMI_VERSION_TEXT, map.K);
    return map.K > 1.05 && map.distortion.flipped.empty() ? 0 : 1;
}
