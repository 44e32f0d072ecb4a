// The parameterizations of CGAL (libcgal-dev) on a mesh, for the page that compares programs:
//
//     bench_cgal MESH.obj METHOD OUT.obj      METHOD: tutte, mean-value, harmonic, lscm, arap
//
// OUT has the map as vt, in MESH's order, for `beltrami measure`; seconds of the parameterization go to standard
// output.
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_authalic_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
#include <CGAL/boost/graph/helpers.h>

#include <chrono>
#include <cstdio>
#include <string>

#include <beltrami/io.h>
#include <beltrami/mesh.h>

using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace smp = CGAL::Surface_mesh_parameterization;
using Border = smp::Circular_border_arc_length_parameterizer_3<SurfaceMesh>;

int main(int argc, char** argv) {
    if (argc != 4) return std::fprintf(stderr, "usage: %s MESH METHOD OUT.obj\n", argv[0]), 2;
    const beltrami::Mesh mesh = beltrami::read_mesh(argv[1]).mesh;
    SurfaceMesh surface;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d at = mesh.point(v);
        vertices.push_back(surface.add_vertex({at.x(), at.y(), at.z()}));
    }
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::vector<SurfaceMesh::Vertex_index> corners;
        for (const int v : mesh.faces[f]) corners.push_back(vertices[static_cast<std::size_t>(v)]);
        surface.add_face(corners);
    }
    const auto border = CGAL::Polygon_mesh_processing::longest_border(surface).first;
    auto places = surface.add_property_map<SurfaceMesh::Vertex_index, Kernel::Point_2>("v:uv").first;
    const std::string method = argv[2];
    const auto begin = std::chrono::steady_clock::now();
    smp::Error_code status = smp::ERROR_WRONG_PARAMETER;
    if (method == "tutte")
        status =
            smp::parameterize(surface, smp::Barycentric_mapping_parameterizer_3<SurfaceMesh, Border>(), border, places);
    if (method == "mean-value")
        status = smp::parameterize(surface, smp::Mean_value_coordinates_parameterizer_3<SurfaceMesh, Border>(), border,
                                   places);
    if (method == "harmonic")
        status = smp::parameterize(surface, smp::Discrete_conformal_map_parameterizer_3<SurfaceMesh, Border>(), border,
                                   places);
    if (method == "lscm") status = smp::parameterize(surface, smp::LSCM_parameterizer_3<SurfaceMesh>(), border, places);
    if (method == "arap") status = smp::parameterize(surface, smp::ARAP_parameterizer_3<SurfaceMesh>(), border, places);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (status != smp::OK) return std::fprintf(stderr, "%s: %s\n", argv[2], smp::get_error_message(status)), 1;
    std::printf("%s %.3f s\n", argv[2], seconds);
    beltrami::Positions map(mesh.vertex_count(), 2);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        map.row(v) << get(places, vertices[static_cast<std::size_t>(v)]).x(),
            get(places, vertices[static_cast<std::size_t>(v)]).y();
    std::FILE* out = std::fopen(argv[3], "w");
    for (int v = 0; v < mesh.vertex_count(); ++v)
        std::fprintf(out, "v %.17g %.17g %.17g\n", mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
    for (int v = 0; v < mesh.vertex_count(); ++v) std::fprintf(out, "vt %.17g %.17g\n", map(v, 0), map(v, 1));
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::fputc('f', out);
        for (const int v : mesh.faces[f]) std::fprintf(out, " %d/%d", v + 1, v + 1);
        std::fputc('\n', out);
    }
    return std::fclose(out);
}
