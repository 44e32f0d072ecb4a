// Maps with a prescribed coefficient, beside Wong & Zhao 2014.
#include <cmath>

#include <beltrami/baselines/perturbation_formula.h>

#include "gallery/flow.h"
#include "gallery/sliding.h"
#include "problems/prescribed_coefficients.h"

namespace beltrami::gallery {

namespace {

/// Coefficients at the middles of the triangles of a planar mesh.
template <class Function>
Eigen::VectorXcd at_middles(const Surface& source, Function&& mu) {
    const Eigen::VectorXcd& z = *source.coordinate();
    Eigen::VectorXcd result(source.operators.sample_count());
    for (int s = 0; s < result.size(); ++s) {
        const auto v = source.operators.stencil(s);
        result[s] = mu((z[v[0]] + z[v[1]] + z[v[2]]) / 3.0);
    }
    return result;
}

/// A row of the paper's Tables 5.1 and 5.2.
struct Theirs {
    int steps;
    double sup, squared;
};

std::string order_of(double before, double error) {
    return before > 0 ? number(std::log2(before / error), 2) : "";
}

/// Columns of a table as curves by the number of faces.
struct Curves {
    std::vector<double> faces, ours, theirs, vertices;
    nlohmann::json panel(const std::string& title) const {
        return curves_panel(
            {{"Σ A |μ_f − μ|²", faces, ours}, {"the paper's", faces, theirs}, {"vertices", faces, vertices}}, title,
            "faces", "error");
    }
};

struct DiskFlow {
    Surface source;
    SurfaceFlowMap flow;
    double seconds = 0;
};

DiskFlow disk_flow(int level, FlowScheme scheme) {
    Surface source(bench::disk_of_square(level));
    const Eigen::VectorXcd mu = at_middles(source, [](Complex z) { return 0.6 * z; });
    TargetConstraints constraints;
    constraints.fixed = {0, 1};
    const DomainTarget target(target_domain(TargetCurve::circle(0, 1)));
    slide_boundary(constraints, source, target, source.mesh.positions);
    const double start = seconds_now();
    SurfaceFlowMap flow =
        surface_flow(source, target, mu, constraints, target_map(source, target, constraints, source.mesh.positions),
                     steps_of(scheme));
    return {std::move(source), std::move(flow), seconds_now() - start};
}

}  // namespace

Figure flow_disk(Output& output) {
    Figure figure{
        "Table 5.1, Figures 5.1 and 5.2: the disk with μ = .6z",
        "Square of corners 1, i, −1, −i split into four again and again, new boundary vertices on the circle; 0 "
        "and 1 are held, the boundary slides. The paper's error is Σ A|μ_f − μ|² without a root, which is of "
        "second order where the root, as the true L² error, is of first; the map's own error, against ζ = z "
        "e^{k z̄} followed by the conformal map back to the disk, is of second order too."};
    const std::vector<Theirs> theirs{{4, .2000, .0800},  {12, .2795, .0813}, {12, .2251, .0458},  {13, .1767, .0176},
                                     {12, .1060, .0052}, {10, .0582, .0013}, {9, .0306, 3.41e-4}, {9, .0157, .855e-4}};
    const bench::DiskStretch exact(0.6);
    Table table{
        "Steps by the perturbation of μ, as the paper's, and automatic ones, which end against a barrier; tolerance "
        "1e-8. The paper's last two "
        "L² entries read here with the exponents that its order demands",
        {"faces", "steps", "paper", "sup", "paper", "Σ A abs(μ_f − μ)²", "paper", "its root", "vertices", "order",
         "flips", "seconds", "automatic: steps", "Σ A abs(μ_f − μ)²", "vertices"},
        {}};
    Curves curves;
    double before = 0;
    for (std::size_t level = 0; level < theirs.size(); ++level) {
        const DiskFlow run = disk_flow(static_cast<int>(level), FlowScheme::perturbation),
                       automatic = disk_flow(static_cast<int>(level), FlowScheme::automatic);
        const auto vertex_error = [&](const DiskFlow& of) {
            const Eigen::VectorXcd images = plane_of(of.flow), &z = *of.source.coordinate();
            double error = 0;
            for (Eigen::Index v = 0; v < z.size(); ++v) error = std::max(error, std::abs(images[v] - exact(z[v])));
            return error;
        };
        const double error = vertex_error(run);
        const SurfaceFlowIteration& last = run.flow.history.back();
        table.rows.push_back({std::to_string(run.source.mesh.face_count()), std::to_string(run.flow.iterations),
                              std::to_string(theirs[level].steps), number(last.error.sup), number(theirs[level].sup),
                              scientific(last.squared_error), scientific(theirs[level].squared), number(last.error.l2),
                              scientific(error), order_of(before, error), std::to_string(last.flips),
                              number(run.seconds, 2), std::to_string(automatic.flow.iterations),
                              scientific(automatic.flow.history.back().squared_error),
                              scientific(vertex_error(automatic))});
        before = error;
        curves.faces.push_back(run.source.mesh.face_count());
        curves.ours.push_back(last.squared_error);
        curves.theirs.push_back(theirs[level].squared);
        curves.vertices.push_back(error);
        if (level == 5) {
            const std::string data =
                output.write("flow_disk", run.source.mesh, plane_of(run.flow), run.flow.distortion.face_abs_mu);
            figure.pictures.push_back({"flow_disk",
                                       "4096 triangles: a polar pattern and its image, |μ|, and the errors by level.",
                                       {grid_panel(data, "image of sectors and rings"), map_panel(data, "|μ|", 0.6),
                                        histogram_panel({{"", data}}, "", {}, 0.7)}});
        }
    }
    figure.pictures[0].panels.push_back(curves.panel("Table 5.1"));
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure flow_sphere(Output& output) {
    Figure figure{
        "Table 5.2, Figures 5.3 and 5.4: the sphere with μ = .3 + .3i",
        "A constant coefficient in the stereographic coordinate, whose map is (z + μz̄)/(1 + μ); 0, 1 and ∞ are held. "
        "At infinity the frame of the coordinate turns without end, so that the largest error stays. Round trip: "
        "the coefficient of the map's own interpolant, from which the map comes back."};
    const std::vector<Theirs> theirs{{9, 0, .1246},  {13, 0, .3892}, {14, 0, .2692}, {14, 0, .1145},
                                     {12, 0, .0412}, {11, 0, .0138}, {10, 0, .0044}};
    constexpr Complex mu0{0.3, 0.3};
    Table table{
        "Octahedral spheres; steps by the perturbation of μ, tolerance 1e-5; round trip: largest error after at most 6 "
        "steps",
        {"faces", "steps", "paper", "Σ A abs(μ_f − μ)²", "paper", "ratio", "vertices", "flips", "seconds",
         "round trip: vertices", "automatic: steps", "Σ A abs(μ_f − μ)²", "ratio", "vertices"},
        {}};
    Curves curves;
    for (std::size_t level = 0; level < theirs.size(); ++level) {
        const Surface source(octahedral_sphere(static_cast<int>(level)));
        const SphereTarget target;
        TargetConstraints constraints;
        constraints.fixed = {0, 4, 5};
        const Positions exact = bench::stretched_sphere(source.mesh.positions, mu0);
        const auto error_of = [&](const SurfaceFlowMap& flow) {
            return (positions_of(flow.map.points) - exact).rowwise().norm().maxCoeff();
        };
        const TargetMap begin = target_map(source, target, constraints, source.mesh.positions);
        const Eigen::VectorXcd mu = mu_at_samples(source, Eigen::VectorXcd::Constant(source.mesh.face_count(), mu0),
                                                  CoefficientFrame::stereographic);
        const double start = seconds_now();
        const SurfaceFlowMap flow = surface_flow(source, target, mu, constraints, begin,
                                                 steps_of(FlowScheme::perturbation, 1e-5 / std::sqrt(12.0)));
        const double seconds = seconds_now() - start;
        const SurfaceFlowMap automatic = surface_flow(source, target, mu, constraints, begin,
                                                      steps_of(FlowScheme::automatic, 1e-5 / std::sqrt(12.0)));
        SurfaceFlowOptions six = steps_of(FlowScheme::perturbation);
        six.max_iterations = 6;
        const SurfaceFlowMap back =
            surface_flow(source, target, beltrami_coefficient(source.operators, exact, exact), constraints, begin, six);
        const double squared = flow.history.back().squared_error;
        table.rows.push_back({std::to_string(source.mesh.face_count()), std::to_string(flow.iterations),
                              std::to_string(theirs[level].steps), scientific(squared),
                              scientific(theirs[level].squared), number(squared / theirs[level].squared, 3),
                              scientific(error_of(flow)), std::to_string(flow.history.back().flips), number(seconds, 2),
                              scientific(error_of(back)), std::to_string(automatic.iterations),
                              scientific(automatic.history.back().squared_error),
                              number(automatic.history.back().squared_error / theirs[level].squared, 3),
                              scientific(error_of(automatic))});
        curves.faces.push_back(source.mesh.face_count());
        curves.ours.push_back(squared);
        curves.theirs.push_back(theirs[level].squared);
        curves.vertices.push_back(error_of(flow));
        if (level == 5) {
            Picture picture{"flow_sphere",
                            "8192 triangles, coloured by the stereographic coordinate, and the errors by level.",
                            {}};
            add_views(output, picture, "flow_sphere", source.mesh, positions_of(flow.map.points),
                      seen_from_south(source.mesh.positions), flow.distortion.face_abs_mu, "checker", 30, 45);
            figure.pictures.push_back(std::move(picture));
        }
    }
    figure.pictures[0].panels.push_back(curves.panel("Table 5.2"));
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure flow_annulus(Output& output) {
    Figure figure{"Figure 5.9: an annulus with μ = .6z³",
                  "Radii .4 and 1. In the structure of μ this ring has the module .8695 and not log 2.5 = .9163, so "
                  "that no map onto "
                  "itself has this μ: there is only the least-squares map. With the inner radius that the module asks "
                  "for there is one."};
    Table table{
        "One vertex of the outer circle is held. Misfit: the part of the relative residual that neighbouring faces "
        "share, "
        "which is no error of the mesh; fits: below .4 of the residual",
        {"faces", "module of μ", "inner radius", "steps", "root mean square", "sup", "residual", "misfit", "fits",
         "flips"},
        {}};
    for (const int around : {64, 128, 256}) {
        const Surface source(annulus(0.4, 1, around));
        const Eigen::VectorXcd& z = *source.coordinate();
        const Eigen::VectorXcd mu = at_middles(source, [](Complex w) { return 0.6 * w * w * w; });
        const auto& loops = source.topology.boundary_loops;
        const int outer = std::abs(z[loops[0][0]]) > 0.7 ? 0 : 1;
        const double module = ring_module(source, mu, outer);
        for (const bool fitting : {false, true}) {
            const double inner = fitting ? std::exp(-module) : 0.4;
            const DomainTarget target(target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0, inner)}));
            Positions start = source.mesh.positions;
            for (int v = 0; v < start.rows(); ++v)
                start.row(v) *= std::pow(std::abs(z[v]), std::log(inner) / std::log(0.4) - 1);
            TargetConstraints constraints;
            constraints.fixed = {loops[outer][0]};
            slide_boundary(constraints, source, target, start);
            const SurfaceFlowMap flow =
                surface_flow(source, target, mu, constraints, target_map(source, target, constraints, start),
                             steps_of(FlowScheme::barrier));
            table.rows.push_back({std::to_string(source.mesh.face_count()), number(module), number(inner),
                                  std::to_string(flow.iterations), number(flow.error.l2), number(flow.error.sup),
                                  number(flow.error.residual), number(flow.error.misfit), flow.fits ? "yes" : "no",
                                  std::to_string(flow.distortion.flipped.size())});
            if (around < 256) continue;
            const std::string name = fitting ? "flow_annulus_fitting" : "flow_annulus",
                              data = output.write(name, source.mesh, plane_of(flow), flow.distortion.face_abs_mu);
            figure.pictures.push_back(
                {name,
                 fitting ? "Onto the ring of the right module." : "Onto itself, in the least-squares sense.",
                 {grid_panel(data, "image of a checkerboard", "square", 20), map_panel(data, "|μ|", 0.6)}});
        }
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure flow_square(Output& output) {
    Figure figure{
        "Table 5.3, Figure 5.14: a square, and the perturbation formula",
        "A diffeomorphism of [−1, 1]² that turns the middle by 2.5 radians, found again from the coefficient of its "
        "interpolant, the boundary held. The integral formula for the motion costs vertices times faces; by the "
        "middles "
        "of the triangles it is a motion with the wanted change of μ only up to the error of the mesh. The paper "
        "does not say which map its square has."};
    Table table{
        "Tolerance 1e-3 both; error: root mean square over the vertices. The paper: 9, 7, 7, 7 steps and 26, 14, 12, "
        "—. "
        "Of the finest grid one step of the formula is measured; growth: against the row before",
        {"vertices", "flow: steps", "seconds a step", "error", "formula: steps", "seconds a step", "growth", "error"},
        {}};
    double before = 0;
    for (const int cells : {32, 64, 128, 256}) {
        Mesh mesh = rectangle(2, 2, cells, cells);
        mesh.positions.array() -= 1;
        const Surface source(mesh);
        const Eigen::VectorXcd& z = *source.coordinate();
        Eigen::VectorXcd exact(z.size());
        for (Eigen::Index v = 0; v < z.size(); ++v) {
            const double x = 1 - z[v].real() * z[v].real(), y = 1 - z[v].imag() * z[v].imag();
            exact[v] = z[v] * std::polar(1.0, 2.5 * x * x * y * y);
        }
        const Eigen::VectorXcd mu = beltrami_coefficient(source.operators, exact);
        TargetConstraints constraints;
        constraints.fixed = source.topology.boundary_loops[0];
        const PlaneTarget target;
        const auto error_of = [&](const Eigen::VectorXcd& map) {
            return std::sqrt((map - exact).squaredNorm() / static_cast<double>(exact.size()));
        };
        double start = seconds_now();
        const SurfaceFlowMap flow = surface_flow(source, target, mu, constraints,
                                                 target_map(source, target, constraints, source.mesh.positions),
                                                 steps_of(FlowScheme::perturbation, 1e-3 / std::sqrt(8.0)));
        const double of_flow = (seconds_now() - start) / flow.iterations;
        std::vector<std::string> row{std::to_string(cells + 1) + "²", std::to_string(flow.iterations),
                                     scientific(of_flow), scientific(error_of(plane_of(flow)))};
        PerturbationFlowOptions formula_options;
        if (cells == 256) formula_options.max_iterations = 1;  // all of them would take the better part of an hour
        start = seconds_now();
        const PerturbationFlow formula = perturbation_flow(source, mu, formula_options);
        const double of_formula = (seconds_now() - start) / formula.iterations;
        row.insert(row.end(), {std::to_string(formula.iterations) + (formula.converged ? "" : ", not settled"),
                               scientific(of_formula), before > 0 ? number(of_formula / before, 1) : "",
                               scientific(error_of(formula.map))});
        before = of_formula;
        table.rows.push_back(std::move(row));
        if (cells == 64) {
            const std::string data = output.write("flow_square", mesh, plane_of(flow), flow.distortion.face_abs_mu);
            figure.pictures.push_back(
                {"flow_square",
                 "The diffeomorphism, 65² vertices.",
                 {grid_panel(data, "image of a checkerboard", "square", 16), map_panel(data, "|μ|")}});
        }
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
