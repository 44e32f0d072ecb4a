// Opens a closed scan by a plane y = height and refines it once: what stays is the part above, a disk.
//
//     open_scan CLOSED.obj HEIGHT OUT.obj
#include <beltrami/io.h>
#include <beltrami/mesh.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "usage: %s CLOSED.obj HEIGHT OUT.obj\n", argv[0]);
        return 2;
    }
    try {
        const beltrami::Mesh closed = beltrami::read_mesh(argv[1]).mesh;
        const beltrami::CutMesh above = beltrami::cut_by_plane(closed, {Eigen::Vector3d::UnitY(), std::stod(argv[2])});
        const beltrami::Mesh open = beltrami::remove_unreferenced(beltrami::largest_component(above.mesh).mesh).mesh;
        const beltrami::Mesh scan = beltrami::midpoint_subdivide(open).mesh;
        beltrami::write_obj(argv[3], scan);
        const beltrami::Topology topology = beltrami::topology(scan);
        std::printf("%s: %d vertices, %d faces, boundary loops %zu, genus %d\n", argv[3], scan.vertex_count(),
                    scan.face_count(), topology.boundary_loops.size(), topology.genus);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
