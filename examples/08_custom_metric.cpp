// A metric of one's own: the square as if it were twice as wide. Then the identity of the square stretches by 2.
#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const beltrami::Mesh square = beltrami::rectangle(1, 1, 24, 24);
    // One point per face corner: every face has the shape of its points.
    const std::vector<int>& corner_vertices = square.faces.vertices();
    beltrami::Positions shapes(static_cast<Eigen::Index>(corner_vertices.size()), 2);
    for (Eigen::Index c = 0; c < shapes.rows(); ++c)
        shapes.row(c) << 2 * square.positions(corner_vertices[c], 0), square.positions(corner_vertices[c], 1);
    const beltrami::Surface source(square, shapes);
    beltrami::BoundaryCondition identity;
    for (const int v : source.topology.boundary_loops[0])
        identity.pin(v, beltrami::Complex(square.positions(v, 0), square.positions(v, 1)));
    const beltrami::ExtremalMap map = beltrami::extremal_map(source, identity);
    std::printf("K = %.6f, bound %.6f\n", map.K, map.K_lower);
}
