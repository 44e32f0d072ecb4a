#include <beltrami/charts/round_disk.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>
#include <beltrami/charts/greens_function.h>
#include <beltrami/charts/vertex_source.h>
#include <beltrami/plane/circle_fit.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/uniformize/flatten.h>

namespace beltrami {

namespace {

/// The real harmonic function with the values of @p boundary on the boundary.
Eigen::VectorXd harmonic_extension(const BeltramiSolver& dirichlet, const Eigen::VectorXd& boundary) {
    return dirichlet.solve(boundary.cast<Complex>()).real();
}

/// From so many samples on flattening a patch instead of the whole surface saves much (docs/performance.md).
constexpr int kGreensFunctionFrom = 8'000;
/// A chart that turns over less of itself is good enough.
constexpr double kMostUnseenOnDisk = 1e-5;
/// The tolerance to which a surface is flattened for a chart, whose own discretisation error is far larger.
constexpr double kRoundTolerance = 1e-8;

/// A point deep inside the flattened surface: the inner vertex where the solution of −Δψ = 1, ψ = 0 on the boundary, is
/// largest; without inner vertices, the middle of the largest face.
Complex deep_point(const Surface& source, const BeltramiSolver& dirichlet, const Eigen::VectorXcd& w) {
    const Eigen::VectorXd squares = w.cwiseAbs2();
    const Eigen::VectorXd depth = harmonic_extension(dirichlet, squares) - squares;  // 4ψ, as Δ|w|² = 4
    int deepest = -1;
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v] && (deepest < 0 || depth[v] > depth[deepest])) deepest = v;
    if (deepest >= 0) return w[deepest];
    const auto largest = std::max_element(source.operators.weights.begin(), source.operators.weights.end());
    Complex middle = 0;
    const auto face = source.operators.stencil(static_cast<int>(largest - source.operators.weights.begin()));
    for (const int v : face) middle += w[v] / static_cast<double>(face.size());
    return middle;
}

void slide(const Surface& source, Eigen::VectorXcd& g, const RoundDiskOptions& options, int* factorizations) {
    const auto& loop = source.topology.boundary_loops[0];
    const int n = source.mesh.vertex_count();
    std::vector<Freedom> freedom(n, Freedom::fixed);
    for (const int v : source.mesh.faces.vertices()) freedom[v] = Freedom::free;
    for (const int v : loop) freedom[v] = Freedom::sliding;
    // Three held vertices, a third of the circle apart in the present map.
    double turned = 0;
    int held = 0;
    for (std::size_t i = 0; i < loop.size() && held < 3; ++i) {
        if (turned >= held * 2 * kPi / 3 - 1e-12) {
            freedom[loop[i]] = Freedom::fixed;
            ++held;
        }
        turned += std::arg(g[loop[(i + 1) % loop.size()]] / g[loop[i]]);
    }
    const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(source.operators.sample_count());
    BeltramiSolver solver(source, freedom, options.sliding_steps);
    for (int step = 0; step < options.sliding_steps; ++step) {
        Eigen::VectorXcd tangent = Eigen::VectorXcd::Zero(n);
        Eigen::VectorXd curvature = Eigen::VectorXd::Zero(n);
        for (const int v : loop) tangent[v] = Complex(0, 1) * g[v];
        if (step > 0) {
            const Eigen::VectorXcd force = solver.gradient(g);
            for (const int v : loop) curvature[v] = -std::real(std::conj(force[v]) * g[v]);
        }
        solver.factorize(zero, tangent, curvature);
        ++*factorizations;
        const Eigen::VectorXcd moved = solver.solve(g);
        double largest = 0;
        std::vector<double> turn(loop.size());
        double damping = 1;
        for (std::size_t i = 0; i < loop.size(); ++i)
            turn[i] = std::real((moved[loop[i]] - g[loop[i]]) / tangent[loop[i]]);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::size_t j = (i + 1) % loop.size();
            const double gap = std::arg(g[loop[j]] / g[loop[i]]), closing = turn[i] - turn[j];
            if (gap > 0 && closing > 0.9 * gap) damping = std::min(damping, 0.9 * gap / closing);
            largest = std::max(largest, std::abs(turn[i]));
        }
        for (int v = 0; v < n; ++v)
            if (freedom[v] == Freedom::free) g[v] = moved[v];
        for (std::size_t i = 0; i < loop.size(); ++i) g[loop[i]] *= std::polar(1.0, damping * turn[i]);
        if (damping * largest < options.tolerance) break;
    }
    // Interior for the final boundary.
    for (const int v : loop) freedom[v] = Freedom::fixed;
    BeltramiSolver inside(source, freedom, 1);
    inside.factorize(zero);
    ++*factorizations;
    g = inside.solve(g);
}

}  // namespace

void centre_in_disk(Eigen::VectorXcd& points, const Eigen::VectorXd& weights) {
    const double total = weights.sum();
    for (int step = 0; step < 200; ++step) {
        const Complex mean = weights.cast<Complex>().cwiseProduct(points).sum() / total;
        if (std::abs(mean) < 1e-14) break;
        parallel_for(0, static_cast<int>(points.size()), [&](int begin, int end) {
            for (int v = begin; v < end; ++v) {
                const Complex below = 1.0 - std::conj(mean) * points[v];
                points[v] = (points[v] - mean) * std::conj(below) / std::norm(below);
            }
        });
    }
}

namespace {

/// Maps to the disk, 0 at a point deep inside, |g| = 1 on the boundary up to discretisation: what does not depend on
/// how the conjugate function is found is found once.
class DiskMaps {
  public:
    DiskMaps(const Surface& source, const BeltramiSolver& dirichlet, int* factorizations)
        : source_(source), dirichlet_(dirichlet), factorizations_(factorizations) {
        if (!source.in_plane() && source.operators.sample_count() >= kGreensFunctionFrom)
            greens_ = greens_function(source, dirichlet);
        if (!greens_) flatten_all();
    }
    Eigen::VectorXcd by(ConjugateBy way) const {
        if (greens_) return disk_map_by_greens_function(source_, dirichlet_, *greens_, way, factorizations_);
        const Eigen::VectorXcd h = with_conjugate(source_, dirichlet_, way, regular_, {}, -1, factorizations_);
        Eigen::VectorXcd g(from_pole_.size());
        for (Eigen::Index v = 0; v < g.size(); ++v) g[v] = from_pole_[v] * std::exp(h[v]);
        return g;
    }

  private:
    /// g = (w − p) exp(h + i h*), h = −log|w − p| on the boundary, where w is the plane or flattens the whole surface.
    void flatten_all() {
        Eigen::VectorXcd w;
        if (const Eigen::VectorXcd* z = source_.coordinate()) {
            w = *z;
        } else {
            FlattenOptions options;
            options.tolerance = kRoundTolerance;
            const Flattening flat =
                source_.metric ? flatten(source_.mesh, *source_.metric, options) : flatten(source_.mesh, options);
            w = flat.positions;
            *factorizations_ += flat.factorizations;
        }
        from_pole_ = w.array() - deep_point(source_, dirichlet_, w);
        Eigen::VectorXd real = Eigen::VectorXd::Zero(w.size());
        for (const int v : source_.topology.boundary_loops[0]) real[v] = -std::log(std::abs(from_pole_[v]));
        regular_ = harmonic_extension(dirichlet_, real);
    }

    const Surface& source_;
    const BeltramiSolver& dirichlet_;
    int* factorizations_;
    std::optional<GreensFunction> greens_;
    Eigen::VectorXcd from_pole_;  ///< w − p, where there is no Green's function
    Eigen::VectorXd regular_;     ///< h there
};

/// @param dirichlet may be null
Chart compute_chart(const Surface& source, const BeltramiSolver* dirichlet, const RoundDiskOptions& options) {
    require_disk(source);
    int factorizations = 0;
    if (const Eigen::VectorXcd* w = source.coordinate()) {
        std::vector<Complex> boundary;
        for (const int v : source.topology.boundary_loops[0]) boundary.push_back((*w)[v]);
        const CircleFit circle = fit_circle(boundary);
        if (circle.exact()) return make_chart(source, (w->array() - circle.centre) / circle.radius, true);
    }
    std::optional<BeltramiSolver> own;
    if (!dirichlet) {
        dirichlet = &own.emplace(dirichlet_solver(source));
        ++factorizations;
    }
    const Eigen::VectorXd areas = vertex_areas(source.operators);
    const DiskMaps maps(source, *dirichlet, &factorizations);
    const auto chart_by = [&](ConjugateBy way) {
        Eigen::VectorXcd g = maps.by(way);
        for (const int v : source.topology.boundary_loops[0]) g[v] /= std::abs(g[v]);
        centre_in_disk(g, areas);
        return make_chart(source, std::move(g), false);
    };
    Chart chart = chart_by(ConjugateBy::flux);
    if (chart.excluded_faces > 0)
        if (Chart other = chart_by(ConjugateBy::system); other.excluded_faces < chart.excluded_faces)
            chart = std::move(other);
    if (chart.excluded_faces > 0 && unseen_part(source, chart) > kMostUnseenOnDisk)
        if (auto g = disk_map_by_vertex_source(source, &factorizations)) {
            centre_in_disk(*g, areas);
            if (Chart other = make_chart(source, std::move(*g), false);
                unseen_part(source, other) < unseen_part(source, chart))
                chart = std::move(other);
        }
    if (options.sliding_steps > 0) {
        slide(source, chart.vertices, options, &factorizations);
        chart = make_chart(source, std::move(chart.vertices), false);
    }
    chart.factorizations = factorizations;
    return chart;
}

}  // namespace

Chart round_disk_chart(const Surface& source, const RoundDiskOptions& options) {
    return compute_chart(source, nullptr, options);
}

Chart round_disk_chart(const Surface& source, const BeltramiSolver& dirichlet, const RoundDiskOptions& options) {
    return compute_chart(source, &dirichlet, options);
}

}  // namespace beltrami
