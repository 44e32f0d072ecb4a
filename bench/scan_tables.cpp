// What the treatment of scans rests on: the metric of the surface against the plane of its chart where the truth is
// known, the c-step on cells against that on all faces, and images far longer than wide.
//
//     bench_scan_tables [MESHES] [CASES]
//
// MESHES holds scans (human_face.obj, chinese_lion.obj), CASES holds jb.obj; rows of files that are not there are left
// out.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/problem.h>

namespace {

using namespace beltrami;

/// A surface of revolution over the unit disk whose chart to the disk is known.
struct Charted {
    std::string name;
    Surface surface;
    Eigen::VectorXcd chart;
};

/// @param height of r
/// @param log_rho the logarithm of the chart's radius, up to a constant
template <class Height, class LogRho>
Charted charted(const std::string& name, int triangles, const Height& height, const LogRho& log_rho) {
    Mesh mesh = disk(disk_rings_for_triangles(triangles));
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    Eigen::VectorXcd chart(flat.rows());
    for (Eigen::Index v = 0; v < flat.rows(); ++v) {
        const Complex z(flat(v, 0), flat(v, 1));
        const double r = std::abs(z);
        mesh.positions.row(v) << z.real(), z.imag(), height(r);
        chart[v] = r > 0 ? z / r * std::exp(log_rho(r) - log_rho(1)) : 0.0;
    }
    return {name, Surface(std::move(mesh)), std::move(chart)};
}

Charted paraboloid(int triangles) {
    // d log ρ = √(1 + 4r²) dr/r.
    return charted(
        "paraboloid z = r²", triangles, [](double r) { return r * r; },
        [](double r) {
            const double root = std::sqrt(1 + 4 * r * r);
            return root + std::log(r) - std::log(1 + root);
        });
}

Charted cap(int triangles) {
    constexpr double kRadius = 1.2;
    return charted(
        "part of a sphere", triangles, [](double r) { return std::sqrt(kRadius * kRadius - r * r); },
        [](double r) {  // stereographic projection from the opposite pole
            return std::log(r / (kRadius + std::sqrt(kRadius * kRadius - r * r)));
        });
}

/// μ of absolute value 1/2: K* = 3.
Complex composition(Complex z) {
    const Complex g = z + 0.3 * z * z;
    return std::exp(0.6 * (g + 0.5 * std::conj(g)));
}
Complex lobes(Complex z) {
    const double t = std::arg(z);
    return std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
}

template <class Function>
BoundaryCondition rim_values(const Surface& surface, const Eigen::VectorXcd& places, const Function& f) {
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, f(places[v]));
    return boundary;
}

void metric_rows(const Charted& source) {
    const BoundaryCondition boundary = rim_values(source.surface, source.chart, composition);
    const Eigen::VectorXcd exact = source.chart.unaryExpr([](Complex z) { return composition(z); });
    for (const bool in_chart : {false, true}) {
        ExtremalOptions options;
        options.chart_metric = in_chart;
        options.sharpen = -1;
        const ExtremalMap result = extremal_map(source.surface, boundary, options);
        const Eigen::VectorXd error = (result.map - exact).cwiseAbs();
        fmt::print("| {} | {} | {} | {:.4f} | {:.4f} | {:.1e}, {:.1e} | {:.4f} |\n", source.name,
                   source.surface.mesh.face_count(), in_chart ? "chart" : "surface", result.K, result.K_lower,
                   error.maxCoeff(), std::sqrt(error.squaredNorm() / static_cast<double>(error.size())),
                   result.distortion.standard_deviation);
        std::fflush(stdout);
    }
}

/// φ and k in the plane of the chart with the c-step over all faces or over cells.
struct Solved {
    double k;
    Eigen::VectorXcd map;
    int nodes;
};
Solved solved(const Surface& source, const BoundaryCondition& boundary, CoefficientStep::Sums sums) {
    ExtremalProblem problem(source, boundary, 8);
    problem.set_chart(round_disk_chart(source));
    problem.take_chart_metric();
    const bool cells = sums == CoefficientStep::Sums::over_cells;
    problem.set_singularities({}, cells ? ExtremalOptions{}.cluster_count : source.operators.sample_count(), sums);
    HamiltonIteration iteration(problem.step_in_domain(), problem.coefficient_step(), iteration_options({}));
    HamiltonState state;
    iteration.run(state, problem.starting_space(problem.largest_degree()));
    return {iteration.last_step().k, problem.map_step().map(),
            static_cast<int>(problem.coefficient_step().quadrature().points.size())};
}

void cell_row(const std::string& name, const Surface& source, const BoundaryCondition& boundary) {
    const Solved faces = solved(source, boundary, CoefficientStep::Sums::over_samples),
                 cells = solved(source, boundary, CoefficientStep::Sums::over_cells);
    const double size = (faces.map.array() - faces.map.mean()).abs().maxCoeff();
    fmt::print("| {} | {} | {} | {:.5f} | {:.1e} | {:.1e} |\n", name, source.mesh.face_count(), cells.nodes, faces.k,
               std::abs(cells.k - faces.k),
               (cells.map - faces.map).norm() / std::sqrt(static_cast<double>(faces.map.size())) / size);
    std::fflush(stdout);
}

void long_row(const Surface& source, double width) {
    const BoundaryCondition boundary = boundary_to_rectangle(source, width, 1, std::array{0, 16, 288, 272});
    const ExtremalMap result = extremal_map(source, boundary);
    double moduli = 1;
    for (const Bound& bound : result.bounds)
        if (bound.kind == Bound::Kind::moduli) moduli = std::max(moduli, bound.K);
    fmt::print("| {:g} x 1 | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {} | {} |\n", width, moduli, result.K_lower_proved,
               result.K_lower, result.K, result.iterations, to_string(result.termination));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path meshes = argc > 1 ? argv[1] : "", cases = argc > 2 ? argv[2] : "";
    const auto there = [](const std::filesystem::path& file) { return std::filesystem::exists(file); };
    fmt::print(
        "K* = 3, in the surface's metric and in the plane of its chart:\n\n"
        "| surface | faces | metric | K | K_lower | error of the map: largest, rms | std on the surface |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    metric_rows(cap(2'000));
    for (const int triangles : {2'000, 8'000, 18'000}) metric_rows(paraboloid(triangles));

    fmt::print(
        "\nThe c-step on cells against all faces, in the plane of the chart:\n\n"
        "| case | faces | nodes | k | difference of k | rms difference of the maps, image of size 1 |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    const Charted smooth = paraboloid(8'000);
    cell_row("composition on the paraboloid", smooth.surface, rim_values(smooth.surface, smooth.chart, composition));
    const Charted fine = paraboloid(46'000);
    cell_row("lobes on the paraboloid", fine.surface, rim_values(fine.surface, fine.chart, lobes));
    for (const char* name : {"human_face", "chinese_lion"})
        if (const auto file = meshes / (std::string(name) + ".obj"); there(file)) {
            const Surface scan(read_mesh(file).mesh);
            cell_row(name, scan, boundary_to_disk(scan, 0.5));
        }

    if (const auto file = cases / "jb.obj"; there(file)) {
        const Surface source(read_mesh(file).mesh);
        fmt::print(
            "\njb.obj onto rectangles:\n\n| target | moduli | K_lower_proved | K_lower | K | iterations | |\n"
            "| --- | --- | --- | --- | --- | --- | --- |\n");
        for (const double width : {1.0, 10.0, 100.0}) long_row(source, width);
    }
}
