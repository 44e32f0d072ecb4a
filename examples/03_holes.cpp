// A disk with three holes to a disk whose holes lie nearer to the middle, in two homotopy classes: without turns, and
// with the outer circle turned once against the first hole. Writes the last map.
//
//     holes OUT.obj
#include <beltrami/beltrami.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s OUT.obj\n", argv[0]);
        return 2;
    }
    try {
        beltrami::DomainOptions domain;
        domain.edge_length = 0.05;
        const beltrami::Surface surface(
            beltrami::circle_domain({}, {{{-0.5, 0.0}, 0.12}, {{0.35, 0.4}, 0.1}, {{0.3, -0.45}, 0.15}}, domain));
        const Eigen::VectorXcd z = beltrami::planar_coordinates(surface.mesh);

        // The outer loop stays, every hole goes to a circle nearer to 0, its first vertex in the old direction.
        beltrami::BoundaryCondition boundary;
        for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, z[v]);
        for (int hole = 1; hole <= 3; ++hole) {
            const auto& loop = surface.topology.boundary_loops[hole];
            beltrami::Complex centre = 0;
            for (const int v : loop) centre += z[v] / static_cast<double>(loop.size());
            const auto circle =
                beltrami::hole_to_circle(surface, hole, 0.8 * centre, 0.1, std::arg(z[loop[0]] - centre));
            for (std::size_t i = 0; i < circle.vertices.size(); ++i) boundary.pin(circle.vertices[i], circle.images[i]);
        }

        for (const int turns : {0, 1}) {
            beltrami::Constraints constraints(boundary);
            constraints.correspondence.turns = {0, turns, 0,
                                                0};  // one number a loop; that of the outer loop does not count
            const beltrami::ExtremalMap result = beltrami::extremal_map(surface, constraints);
            std::printf("hole 1 turned by %d: K = %.3f, no map of this class has less than %.3f; %zu faces flipped\n",
                        result.homotopy.holes[0].turns, result.K, result.K_lower, result.distortion.flipped.size());
            beltrami::Positions vt(result.map.size(), 2);
            vt << result.map.real(), result.map.imag();
            beltrami::write_mesh(argv[1], {result.split ? result.split->mesh : surface.mesh, vt});
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
