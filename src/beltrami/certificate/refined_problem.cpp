#include <beltrami/certificate/refined_problem.h>

#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/mesh/quad_split.h>

namespace beltrami {

namespace {

/// The corners of a metric in the order of midpoint_subdivide's faces.
Positions subdivided_corners(const FaceList& faces, const Positions& corners) {
    std::vector<Eigen::RowVectorXd> rows;
    for (int f = 0; f < faces.size(); ++f) {
        const int n = faces.degree(f);
        const Positions v = corners.middleRows(faces.first_corner(f), n);
        Positions m(n, v.cols());
        for (int j = 0; j < n; ++j) m.row(j) = 0.5 * (v.row(j) + v.row((j + 1) % n));
        const Eigen::RowVectorXd centre = v.colwise().mean();
        for (int j = 0; j < n; ++j) {
            rows.push_back(v.row(j));
            rows.push_back(m.row(j));
            if (n == 4) rows.push_back(centre);
            rows.push_back(m.row((j + n - 1) % n));
        }
        for (int j = 0; n == 3 && j < n; ++j) rows.push_back(m.row(j));
    }
    Positions result(static_cast<Eigen::Index>(rows.size()), corners.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = rows[i];
    return result;
}

}  // namespace

bool all_triangles(const Mesh& mesh) {
    for (int f = 0; f < mesh.face_count(); ++f)
        if (mesh.faces.degree(f) != 3) return false;
    return true;
}

Surface cut_into_triangles(const Surface& source) {
    const Mesh& mesh = source.mesh;
    Mesh result;
    result.positions = mesh.positions;
    std::vector<int> corners;  // old corner of every new one
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        const int first = mesh.faces.first_corner(f);
        if (v.size() == 3) {
            result.faces.add(v);
            for (int j = 0; j < 3; ++j) corners.push_back(first + j);
            continue;
        }
        for (const auto& [a, b, c] :
             split_quad({mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])})) {
            result.faces.add({v[a], v[b], v[c]});
            for (const int j : {a, b, c}) corners.push_back(first + j);
        }
    }
    std::optional<Positions> metric;
    if (source.metric) metric = (*source.metric)(corners, Eigen::all);
    return surface_of(std::move(result), std::move(metric));
}

RefinedProblem refined_problem(const Surface& source, const BoundaryCondition& boundary) {
    SubdividedMesh fine = midpoint_subdivide(source.mesh);
    std::optional<Positions> metric;
    if (source.metric) metric = subdivided_corners(source.mesh.faces, *source.metric);
    const int vertices = source.mesh.vertex_count();
    const Topology& topology = source.topology;
    const Eigen::VectorXcd values = prescribed_values(boundary, source);
    BoundaryCondition finer = boundary;
    const Eigen::VectorXcd directions = line_directions(boundary, source);
    const std::vector<EdgeConstraint> inner = edge_constraints(boundary, source);
    for (int e = 0; e < topology.edge_count(); ++e) {
        const auto [a, b] = topology.edges[e];
        const bool rim = topology.edge_faces[e][0] < 0 || topology.edge_faces[e][1] < 0;
        if (rim || inner[e] == EdgeConstraint::pinned) {
            finer.pin(vertices + e, 0.5 * (values[a] + values[b]));
        } else if (inner[e] == EdgeConstraint::on_line) {
            const int held = directions[a] != 0.0 ? a : b;
            finer.pin_to_line(vertices + e, values[held], directions[held]);
        }
    }
    return {surface_of(std::move(fine.mesh), std::move(metric)), std::move(finer), std::move(fine.parents)};
}

Eigen::VectorXcd RefinedProblem::interpolated(const Eigen::VectorXcd& values) const {
    return with_parents_means(values, parents);
}

}  // namespace beltrami
