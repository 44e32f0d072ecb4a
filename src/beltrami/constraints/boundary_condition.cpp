#include <beltrami/constraints/boundary_condition.h>

#include <cmath>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

void require_vertex(int v, int vertices) {
    if (v >= 0 && v < vertices) return;
    throw Error(Cause::bad_boundary,
                "vertex " + std::to_string(v) + " is pinned, but the mesh has the vertices 0 to " +
                    std::to_string(vertices - 1),
                "vertices are counted from 0 in file order", {Things::vertices, {v}});
}

}  // namespace

void validate(const BoundaryCondition& boundary, const Surface& source) {
    if (boundary.vertices.size() != boundary.images.size())
        throw Error(Cause::bad_boundary, "the boundary condition has " + std::to_string(boundary.vertices.size()) +
                                             " vertices but " + std::to_string(boundary.images.size()) + " images");
    const int n = source.mesh.vertex_count();
    std::vector<char> seen(n, 0);
    const auto see = [&](int v) {
        require_vertex(v, n);
        if (seen[v])
            throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " is pinned twice",
                        "give one image per vertex", {Things::vertices, {v}});
        seen[v] = 1;
    };
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
        const int v = boundary.vertices[i];
        see(v);
        if (!std::isfinite(boundary.images[i].real()) || !std::isfinite(boundary.images[i].imag()))
            throw Error(Cause::bad_boundary, "the image of vertex " + std::to_string(v) + " is not finite",
                        "give two numbers", {Things::vertices, {v}});
    }
    for (const auto& [v, point, direction] : boundary.lines) {
        see(v);
        if (source.topology.on_boundary[v])
            throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " lies on the boundary and may not slide",
                        "give its image point", {Things::vertices, {v}});
        if (!std::isfinite(std::abs(point)) || !std::isfinite(std::abs(direction)) || direction == 0.0)
            throw Error(Cause::bad_boundary, "the line of vertex " + std::to_string(v) + " is not a line",
                        "give a finite point and a direction", {Things::vertices, {v}});
    }
}

std::vector<int> unprescribed_boundary(const BoundaryCondition& boundary, const Surface& source) {
    std::vector<char> pinned(source.mesh.vertex_count(), 0);
    for (const int v : boundary.vertices) {
        require_vertex(v, source.mesh.vertex_count());
        pinned[v] = 1;
    }
    std::vector<int> missing;
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop)
            if (!pinned[v]) missing.push_back(v);
    return missing;
}

void require_whole_boundary(const BoundaryCondition& boundary, const Surface& source) {
    const std::vector<int> missing = unprescribed_boundary(boundary, source);
    if (missing.empty()) return;
    std::vector<char> is_missing(source.mesh.vertex_count(), 0);
    for (const int v : missing) is_missing[v] = 1;
    std::string sentence;
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        const auto& loop = source.topology.boundary_loops[l];
        int count = 0, first = -1;
        for (const int v : loop)
            if (is_missing[v] && count++ == 0) first = v;
        if (count)
            sentence += (sentence.empty() ? "" : "; ") + ("boundary loop " + std::to_string(l)) + " (" +
                        std::to_string(loop.size()) + " vertices) has " + std::to_string(count) +
                        " without a prescribed image, the first is vertex " + std::to_string(first);
    }
    throw Error(Cause::bad_boundary, sentence,
                "prescribe every boundary vertex, or take the map of least maximum, for which parts may be free",
                {Things::vertices, missing});
}

std::vector<Freedom> freedoms(const BoundaryCondition& boundary, const Surface& source) {
    std::vector<Freedom> result(source.mesh.vertex_count(), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices()) result[v] = Freedom::free;
    for (const int v : boundary.vertices) result[v] = Freedom::fixed;
    for (const auto& line : boundary.lines) result[line.vertex] = Freedom::sliding;
    return result;
}

Eigen::VectorXcd prescribed_values(const BoundaryCondition& boundary, const Surface& source) {
    Eigen::VectorXcd values = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) values[boundary.vertices[i]] = boundary.images[i];
    for (const auto& line : boundary.lines) values[line.vertex] = line.point;
    return values;
}

Eigen::VectorXcd line_directions(const BoundaryCondition& boundary, const Surface& source) {
    if (boundary.lines.empty()) return {};
    Eigen::VectorXcd directions = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    for (const auto& line : boundary.lines) directions[line.vertex] = line.direction / std::abs(line.direction);
    return directions;
}

}  // namespace beltrami
