#include "openings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <vector>

#include <beltrami/forms/cut_open.h>
#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/mesh/topology.h>

namespace beltrami::bench {

namespace {

Eigen::Vector3d longest_axis(const Positions& positions) {
    const Eigen::RowVector3d mean = positions.colwise().mean();
    const Eigen::MatrixXd from_mean = positions.rowwise() - mean;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(from_mean.transpose() * from_mean);
    return axes.eigenvectors().col(2);
}

double boundary_length(const Mesh& mesh) {
    double length = 0;
    for (const auto& loop : topology(mesh).boundary_loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            length += (mesh.positions.row(loop[(i + 1) % loop.size()]) - mesh.positions.row(loop[i])).norm();
    return length;
}

}  // namespace

Mesh opened_by_plane(const Mesh& closed, double part) {
    Mesh best;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const double factor : {1.0, 0.5, 0.25, 2.0, 3.0}) {
        double shortest = std::numeric_limits<double>::infinity();
        for (const double side : {1.0, -1.0}) {
            const Eigen::Vector3d axis = side * longest_axis(closed.positions);
            std::vector<double> heights;
            for (Eigen::Index v = 0; v < closed.positions.rows(); ++v)
                heights.push_back(closed.positions.row(v).dot(axis));
            std::sort(heights.begin(), heights.end());
            const double at = heights[static_cast<std::size_t>(factor * part * static_cast<double>(heights.size()))];
            Mesh open = remove_unreferenced(largest_component(cut_by_plane(closed, {axis, at}).mesh).mesh).mesh;
            const std::size_t loops = topology(open).boundary_loops.size();
            const double length = boundary_length(open);
            if (loops == 0 || loops > fewest || (loops == fewest && !(length < shortest))) continue;
            fewest = loops;
            shortest = length;
            best = std::move(open);
        }
        if (fewest == 1) break;
    }
    return best;
}

Mesh opened_by_seam(const Mesh& closed) {
    return cut_open(Surface(closed)).disk;
}

}  // namespace beltrami::bench
