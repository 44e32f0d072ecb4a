#include <beltrami/teichmuller/pieces.h>

#include <algorithm>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Component of every face, counted from 0 by their first faces.
std::vector<int> components_of(const Surface& source, const BoundaryCondition& boundary, int& count) {
    const std::vector<EdgeConstraint> constraints = edge_constraints(boundary, source);
    const Topology& topology = source.topology;
    DisjointSets sets(source.mesh.face_count());
    for (int e = 0; e < topology.edge_count(); ++e) {
        const auto& [left, right] = topology.edge_faces[e];
        if (left >= 0 && right >= 0 && constraints[e] != EdgeConstraint::pinned) sets.join(left, right);
    }
    std::vector<int> component(source.mesh.face_count());
    count = 0;
    for (int f = 0; f < source.mesh.face_count(); ++f)
        component[f] = sets.find(f) == f ? count++ : component[sets.find(f)];
    return component;
}

Positions metric_of(const Surface& source, const std::vector<int>& faces) {
    std::vector<int> corners;
    for (const int f : faces)
        for (int j = 0; j < source.mesh.faces.degree(f); ++j) corners.push_back(source.mesh.faces.first_corner(f) + j);
    return (*source.metric)(corners, Eigen::all);
}

/// The loop whose image is counter-clockwise; -1 unless there is exactly one.
int outer_loop_of(const Surface& surface, const BoundaryCondition& boundary) {
    std::vector<Complex> image(surface.mesh.vertex_count());
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) image[boundary.vertices[i]] = boundary.images[i];
    int outer = -1;
    for (std::size_t l = 0; l < surface.topology.boundary_loops.size(); ++l) {
        const auto& loop = surface.topology.boundary_loops[l];
        double area = 0;
        for (std::size_t i = 0; i < loop.size(); ++i)
            area += std::imag(std::conj(image[loop[i]]) * image[loop[(i + 1) % loop.size()]]);
        if (!(area > 0)) continue;
        if (outer >= 0) return -1;
        outer = static_cast<int>(l);
    }
    return outer;
}

}  // namespace

ProblemPieces pieces_of(const Surface& source, const BoundaryCondition& boundary) {
    ProblemPieces result;
    int count = 0;
    const std::vector<int> component = components_of(source, boundary, count);
    if (count == 1) return result;
    std::vector<std::vector<int>> faces(count);
    for (int f = 0; f < source.mesh.face_count(); ++f) faces[component[f]].push_back(f);
    std::vector<std::vector<int>> samples(count);
    for (int s = 0; s < source.operators.sample_count(); ++s)
        samples[component[source.operators.faces[s]]].push_back(s);

    std::vector<int> local(source.mesh.vertex_count(), -1);
    for (int c = 0; c < count; ++c) {
        Submesh part = keep_faces(source.mesh, faces[c]);
        for (std::size_t i = 0; i < part.vertices.size(); ++i) local[part.vertices[i]] = static_cast<int>(i);
        BoundaryCondition own;
        std::vector<int> pins;
        for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
            if (const int v = local[boundary.vertices[i]]; v >= 0) {
                own.pin(v, boundary.images[i]);
                pins.push_back(static_cast<int>(i));
            }
        for (const auto& line : boundary.lines)
            if (const int v = local[line.vertex]; v >= 0) own.pin_to_line(v, line.point, line.direction);
        for (const int v : part.vertices) local[v] = -1;
        const auto failed = [&](const std::string& why) {
            result.pieces.clear();
            result.obstacle = "pinned curves cut the surface into " + std::to_string(count) +
                              " pieces, but it is solved as one, for in that of face " + std::to_string(faces[c][0]) +
                              " " + why;
            return result;
        };
        if (own.vertices.size() == part.vertices.size()) return failed("no vertex is free");
        try {
            std::optional<Positions> metric;
            if (source.metric) metric = metric_of(source, faces[c]);
            Surface surface = surface_of(std::move(part.mesh), std::move(metric));
            const int outer = outer_loop_of(surface, own);
            if (outer < 0) return failed("the images of the boundary do not run around one place");
            require_feasible(surface, own, outer);
            result.pieces.push_back({std::move(surface), std::move(own), outer, std::move(part.vertices),
                                     std::move(part.faces), std::move(pins), std::move(samples[c])});
        } catch (const Error& error) {
            return failed(std::string("(vertices counted anew) ") + error.what());
        }
    }
    return result;
}

}  // namespace beltrami
