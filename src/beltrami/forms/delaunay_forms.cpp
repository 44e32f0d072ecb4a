#include <beltrami/forms/delaunay_forms.h>

#include <array>

#include <beltrami/linear/graph_laplacian.h>

namespace beltrami::detail {

namespace {

/// The forms of a basis along the half-edges of the surface in triangles; along the diagonal of a quad they have the
/// value of the way around.
Eigen::MatrixXd on_triangles(const Surface& surface, const TriangleMetric& metric, const Eigen::MatrixXi& cochains) {
    const FaceList& faces = surface.mesh.faces;
    Eigen::MatrixXd values(metric.triangles.corner_count(), cochains.cols());
    for (int t = 0; t < metric.triangles.size(); ++t) {
        const auto v = metric.triangles[t];
        const auto face = faces[metric.faces[t]];
        const auto n = static_cast<int>(face.size());
        int diagonal = -1;
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(cochains.cols());
        for (int k = 0; k < 3; ++k) {
            int i = 0;
            while (face[i] != v[k]) ++i;
            if (face[(i + 1) % n] != v[(k + 1) % 3]) {
                diagonal = k;
                continue;
            }
            const int edge = surface.topology.corner_edges[faces.first_corner(metric.faces[t]) + i];
            values.row(3 * t + k) = (v[k] < v[(k + 1) % 3] ? 1 : -1) * cochains.row(edge).cast<double>();
            sum += values.row(3 * t + k);
        }
        if (diagonal >= 0) values.row(3 * t + diagonal) = -sum;
    }
    return values;
}

/// Half the cotangent of the angle opposite every half-edge.
std::vector<double> weights_of(const IntrinsicTriangulation& triangulation) {
    std::vector<double> weights(static_cast<std::size_t>(triangulation.halfedge_count()));
    for (int t = 0; t < triangulation.triangle_count(); ++t) {
        const int h = 3 * t;
        const TriangleAngles angles = triangle_angles(
            {triangulation.log_length(h), triangulation.log_length(h + 1), triangulation.log_length(h + 2)});
        for (int k = 0; k < 3; ++k) weights[h + k] = 0.5 * angles.cotangents[k];
    }
    return weights;
}

}  // namespace

DelaunayForms::DelaunayForms(const Surface& surface, const HomologyBasis& basis)
    : metric(triangle_metric(surface.mesh, surface.topology,
                             surface.metric ? *surface.metric : corner_positions(surface.mesh))),
      triangulation(metric.triangles, surface.mesh.vertex_count(), metric.log_lengths),
      flips(triangulation.delaunay_flips()),
      cochains(on_triangles(surface, metric, basis.cochains)) {
    carry_forms(flips, cochains);
    solve();
    measure();
}

/// Σ w (value + difference of potentials) = 0 at every vertex; the first one has potential 0.
void DelaunayForms::solve() {
    const std::vector<double> weights = weights_of(triangulation);
    std::vector<std::array<int, 2>> ends;
    std::vector<double> edge_weights;
    std::vector<char> held(static_cast<std::size_t>(triangulation.vertex_count()), 1);
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(triangulation.vertex_count(), cochains.cols());
    for (int h = 0; h < triangulation.halfedge_count(); ++h) {
        const int a = triangulation.tail(h), b = triangulation.head(h), twin = triangulation.twin(h);
        held[a] = 0;
        load.row(a) += weights[h] * cochains.row(h);
        load.row(b) -= weights[h] * cochains.row(h);
        if (h < twin) continue;
        ends.push_back({a, b});
        edge_weights.push_back(weights[h] + (twin >= 0 ? weights[twin] : 0.0));
    }
    held[triangulation.tail(0)] = 1;
    GraphLaplacian laplacian(std::move(ends), held);
    laplacian.set(edge_weights);
    laplacian.factorize();
    potentials = laplacian.solve(load);
}

void DelaunayForms::measure() {
    const std::vector<double> weights = weights_of(triangulation);
    energies = Eigen::MatrixXd::Zero(cochains.cols(), cochains.cols());
    for (int h = 0; h < triangulation.halfedge_count(); ++h) {
        const Eigen::RowVectorXd value = along(h);
        energies += weights[h] * value.transpose() * value;
    }
}

}  // namespace beltrami::detail
