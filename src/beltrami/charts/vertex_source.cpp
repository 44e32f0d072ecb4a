#include <beltrami/charts/vertex_source.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <beltrami/charts/chart.h>
#include <beltrami/linear/symmetric_solver.h>
#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {

namespace {

/// The surface's triangles by their edge lengths, flipped until they are Delaunay.
IntrinsicTriangulation delaunay_of(const Surface& source) {
    const FaceList& faces = source.mesh.faces;
    const auto point = [&](int corner) -> Eigen::RowVectorXd {
        if (source.metric) return source.metric->row(corner);
        return source.mesh.positions.row(faces.vertices()[corner]);
    };
    // Both sides of an edge agree: the mean, where faces of a metric differ about it.
    std::vector<double> lengths(source.topology.edges.size(), -1);
    for (int c = 0; c < faces.corner_count(); ++c) {
        const int next = c % 3 == 2 ? c - 2 : c + 1;
        const double length = (point(next) - point(c)).stableNorm();
        double& known = lengths[source.topology.corner_edges[c]];
        known = known < 0 ? length : std::midpoint(known, length);
    }
    std::vector<double> logarithms(faces.corner_count());
    for (int c = 0; c < faces.corner_count(); ++c) logarithms[c] = std::log(lengths[source.topology.corner_edges[c]]);
    IntrinsicTriangulation triangulation(faces, source.mesh.vertex_count(), std::move(logarithms));
    triangulation.make_delaunay();
    return triangulation;
}

/// The Laplacian with the rim's values fixed.
class DirichletLaplacian {
  public:
    DirichletLaplacian(const Surface& source, const IntrinsicTriangulation& triangulation)
        : unknown_(source.mesh.vertex_count(), -1) {
        std::vector<char> used(unknown_.size(), 0);
        for (const int v : source.mesh.faces.vertices()) used[v] = 1;
        for (std::size_t v = 0; v < unknown_.size(); ++v)
            if (used[v] && !source.topology.on_boundary[v]) unknown_[v] = count_++;
        const Eigen::VectorXd as_it_is = Eigen::VectorXd::Zero(triangulation.vertex_count());
        std::vector<Eigen::Triplet<double>> inside;
        for (int t = 0; t < triangulation.triangle_count(); ++t) {
            const TriangleAngles triangle = triangulation.angles(t, as_it_is);
            for (int k = 0; k < 3; ++k) {
                const int h = 3 * t + k, a = triangulation.tail(h), b = triangulation.head(h);
                const double w = 0.5 * triangle.cotangents[k];
                if (a == b) continue;
                const int i = unknown_[a], j = unknown_[b];
                if (i >= 0) inside.emplace_back(i, i, w);
                if (j >= 0) inside.emplace_back(j, j, w);
                if (i >= 0 && j >= 0)
                    inside.emplace_back(std::max(i, j), std::min(i, j), -w);
                else if (i >= 0 || j >= 0)
                    to_rim_.push_back({i >= 0 ? i : j, i >= 0 ? b : a, w});
            }
        }
        SymmetricSolver::Matrix matrix(count_, count_);
        matrix.setFromTriplets(inside.begin(), inside.end());
        if (count_ > 0) {
            solver_.emplace(std::move(matrix), 1);
            solver_->factorize();
        }
    }
    int unknowns() const { return count_; }

    /// Inner values for a load at the inner vertices and 0 on the rim, #unknowns.
    Eigen::MatrixXd solve(const Eigen::MatrixXd& load) const { return solver_->solve(load); }
    int unknown(int vertex) const { return unknown_[vertex]; }

    /// #V what flows out at the rim of a function that is 0 there.
    Eigen::VectorXd flux(const Eigen::VectorXd& inner) const {
        Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown_.size()));
        for (const Link& link : to_rim_) result[link.rim] += link.weight * inner[link.inner];
        return result;
    }

    /// The harmonic extension of values at the rim.
    Eigen::VectorXcd extend(Eigen::VectorXcd values) const {
        Eigen::MatrixXd load = Eigen::MatrixXd::Zero(count_, 2);
        for (const Link& link : to_rim_) {
            load(link.inner, 0) += link.weight * values[link.rim].real();
            load(link.inner, 1) += link.weight * values[link.rim].imag();
        }
        const Eigen::MatrixXd inner = solver_->solve(load);
        for (std::size_t v = 0; v < unknown_.size(); ++v)
            if (unknown_[v] >= 0) values[static_cast<Eigen::Index>(v)] = {inner(unknown_[v], 0), inner(unknown_[v], 1)};
        return values;
    }

  private:
    struct Link {
        int inner, rim;
        double weight;
    };
    std::vector<int> unknown_;
    std::vector<Link> to_rim_;
    int count_ = 0;
    std::optional<SymmetricSolver> solver_;
};

}  // namespace

std::optional<Eigen::VectorXcd> disk_map_by_vertex_source(const Surface& source, int* factorizations) {
    const DirichletLaplacian laplacian(source, delaunay_of(source));
    if (laplacian.unknowns() == 0) return {};
    ++*factorizations;
    const Eigen::VectorXd areas = vertex_areas(source.operators);
    Eigen::MatrixXd load(laplacian.unknowns(), 1);
    for (Eigen::Index v = 0; v < areas.size(); ++v)
        if (laplacian.unknown(static_cast<int>(v)) >= 0) load(laplacian.unknown(static_cast<int>(v)), 0) = areas[v];
    Eigen::Index deepest = 0;
    laplacian.solve(load).col(0).maxCoeff(&deepest);
    load.setZero();
    load(deepest, 0) = 1;
    const Eigen::VectorXd flux = laplacian.flux(laplacian.solve(load));

    const auto& rim = source.topology.boundary_loops[0];
    const std::size_t n = rim.size();
    double total = 0;
    for (const int v : rim) total += flux[v];
    Eigen::VectorXcd g = Eigen::VectorXcd::Zero(areas.size());
    double angle = 0;
    for (std::size_t i = 0; i < n; ++i) {
        g[rim[i]] = std::polar(1.0, angle);
        const double step = 0.5 * (flux[rim[i]] + flux[rim[(i + 1) % n]]);
        if (!(step > 0)) return {};
        angle += 2 * std::numbers::pi * step / total;
    }
    return laplacian.extend(std::move(g));
}

}  // namespace beltrami
