#include "isotropic.h"

#include <map>
#include <numbers>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <beltrami/locate/surface_locator.h>

beltrami::Mesh isotropic_remeshing(const beltrami::Mesh& mesh, double edge, int iterations,
                                   std::optional<double> features) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    namespace processing = CGAL::Polygon_mesh_processing;
    Surface surface;
    std::vector<Surface::Vertex_index> vertices;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        vertices.push_back(surface.add_vertex({p.x(), p.y(), p.z()}));
    }
    std::vector<int> faces;
    for (const auto& [a, b, c] : beltrami::as_triangles(mesh.faces, mesh.positions, faces))
        surface.add_face(vertices[a], vertices[b], vertices[c]);
    auto kept = surface.add_property_map<Surface::Edge_index, bool>("kept", false).first;
    if (features) processing::detect_sharp_edges(surface, *features * 180 / std::numbers::pi, kept);
    processing::isotropic_remeshing(surface.faces(), edge, surface,
                                    CGAL::parameters::number_of_iterations(iterations)
                                        .protect_constraints(false)
                                        .edge_is_constrained_map(kept)
                                        .number_of_relaxation_steps(3));
    beltrami::Mesh result;
    std::map<Surface::Vertex_index, int> numbers;
    for (const auto v : surface.vertices()) numbers.insert({v, static_cast<int>(numbers.size())});
    result.positions.resize(static_cast<Eigen::Index>(numbers.size()), 3);
    for (const auto& [v, number] : numbers) {
        const auto& p = surface.point(v);
        result.positions.row(number) << p.x(), p.y(), p.z();
    }
    for (const auto f : surface.faces()) {
        std::vector<int> corners;
        for (const auto v : CGAL::vertices_around_face(surface.halfedge(f), surface)) corners.push_back(numbers.at(v));
        result.faces.add(corners);
    }
    return result;
}
