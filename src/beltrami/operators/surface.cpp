#include <beltrami/operators/surface.h>

#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/mesh/planar.h>

namespace beltrami {

namespace {

std::vector<std::vector<double>> lengths_of_loops(const Surface& s) {
    // The face corner at which the boundary edge that leaves a vertex begins.
    std::vector<int> corner(s.mesh.vertex_count(), -1), next(s.mesh.faces.corner_count());
    for (int f = 0; f < s.mesh.face_count(); ++f)
        for (int first = s.mesh.faces.first_corner(f), degree = s.mesh.faces.degree(f), j = 0; j < degree; ++j) {
            const int c = first + j;
            next[c] = first + (j + 1) % degree;
            const auto& sides = s.topology.edge_faces[s.topology.corner_edges[c]];
            if (sides[0] < 0 || sides[1] < 0) corner[s.mesh.faces.vertices()[c]] = c;
        }
    const auto point = [&](int c) -> Eigen::Vector3d {
        if (!s.metric) return s.mesh.point(s.mesh.faces.vertices()[c]);
        return {(*s.metric)(c, 0), (*s.metric)(c, 1), s.metric->cols() > 2 ? (*s.metric)(c, 2) : 0.0};
    };
    std::vector<std::vector<double>> lengths;
    for (const auto& loop : s.topology.boundary_loops) {
        auto& of_loop = lengths.emplace_back();
        for (const int v : loop) of_loop.push_back((point(next[corner[v]]) - point(corner[v])).norm());
    }
    return lengths;
}

/// Topology beside operators; of sound meshes alone, as neither looks where what it reads may not be.
template <class MakeOperators>
void examine(Surface& s, MakeOperators&& make_operators) {
    s.findings = require_sound(s.mesh);
    parallel_for_each(2, [&](int part) {
        if (part == 0)
            s.topology = topology(s.mesh);
        else
            s.operators = make_operators();
    });
}

}  // namespace

Surface::Surface(Mesh m) : mesh(std::move(m)) {
    examine(*this, [this] { return beltrami::operators(mesh); });
    boundary_edge_lengths = lengths_of_loops(*this);
    if (is_planar(mesh)) coordinate_ = planar_coordinates(mesh);
}

Surface::Surface(Mesh m, Positions corners) : mesh(std::move(m)), metric(std::move(corners)) {
    examine(*this, [this] { return operators_from_corners(mesh, *metric); });
    boundary_edge_lengths = lengths_of_loops(*this);
}

Surface surface_of(Mesh mesh, std::optional<Positions> metric) {
    return metric ? Surface(std::move(mesh), std::move(*metric)) : Surface(std::move(mesh));
}

void require_disk(const Surface& surface) {
    const Topology& topology = surface.topology;
    if (topology.components == 1 && topology.boundary_loops.size() == 1 && topology.genus == 0) return;
    throw Error(Cause::bad_mesh,
                "the surface is not a disk: components " + std::to_string(topology.components) + ", boundary loops " +
                    std::to_string(topology.boundary_loops.size()) + ", genus " + std::to_string(topology.genus),
                "cut or fill it until one component with one boundary loop is left");
}

void require_open_component(const Surface& surface) {
    if (surface.topology.components != 1)
        throw Error(Cause::bad_mesh, "the mesh has " + std::to_string(surface.topology.components) + " components",
                    "keep one of them, or map each by itself");
    if (surface.topology.boundary_loops.empty())
        throw Error(Cause::bad_mesh, "the mesh is a closed surface, which has no map to the plane without folds",
                    "cut it open first");
}

void require_genus_zero(const Surface& surface) {
    const Topology& topology = surface.topology;
    if (topology.components == 1 && !topology.boundary_loops.empty() && topology.genus == 0) return;
    throw Error(Cause::bad_mesh,
                "the surface is not part of a plane: components " + std::to_string(topology.components) +
                    ", boundary loops " + std::to_string(topology.boundary_loops.size()) + ", genus " +
                    std::to_string(topology.genus),
                "cut it until one component of genus 0 with a boundary is left");
}

}  // namespace beltrami
