// Maps along surfaces in space with a prescribed coefficient or of least distortion: beside Wong & Zhao 2014.
#include <chrono>
#include <cmath>
#include <numbers>

#include <beltrami/base/random.h>
#include <beltrami/baselines/perturbation_formula.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/unfold/sphere_tutte.h>

#include "gallery/sliding.h"
#include "problems/prescribed_coefficients.h"

namespace beltrami::gallery {

namespace {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

SurfaceFlowOptions steps_of(FlowScheme scheme, double tolerance = 1e-8) {
    SurfaceFlowOptions options;
    options.scheme = scheme;
    options.tolerance = tolerance;
    options.least_decrease = 0;
    return options;
}

Eigen::VectorXcd plane_of(const SurfaceFlowMap& flow) {
    const Positions images = positions_of(flow.map.points);
    return images.col(0) + Complex(0, 1) * images.col(1);
}

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

/// A surface and its image with the same colours, by stereographic coordinates of the image or by a plane map.
void add_views(Output& output, Picture& picture, const std::string& name, const Mesh& source, const Positions& image,
               const Eigen::VectorXcd& plane, const Eigen::VectorXd& abs_mu, const char* colour, double azimuth,
               double elevation) {
    Mesh there = source;
    there.positions = image;
    there.texture.reset();
    const std::string from = output.write(name, source, plane, abs_mu),
                      to = output.write(name + "_image", there, plane, abs_mu);
    picture.panels.push_back(surface_panel(from, "source", colour, azimuth, elevation));
    picture.panels.push_back(surface_panel(to, "image", colour, azimuth, elevation));
    picture.panels.push_back(histogram_panel({{"", from}}, "|μ|", {}, std::clamp(1.2 * abs_mu.maxCoeff(), 0.05, 1.0)));
}

/// Stereographic coordinates, the south pole cut off.
Eigen::VectorXcd seen_from_south(const Positions& sphere) {
    Eigen::VectorXcd z(sphere.rows());
    for (Eigen::Index v = 0; v < sphere.rows(); ++v)
        z[v] = Complex(sphere(v, 0), sphere(v, 1)) / std::max(1 + sphere(v, 2), 0.05);
    return z;
}

/// Numbers of one map to the sphere or a torus.
std::vector<std::string> numbers_of(const SurfaceFlowMap& flow, double seconds) {
    const Distortion& d = flow.distortion;
    return {std::to_string(flow.iterations),  number(d.mean),    number(d.standard_deviation), number(d.max),
            std::to_string(d.flipped.size()), number(seconds, 2)};
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

namespace {

/// A capsule bent by so many radians.
Mesh bent_capsule(int levels, double bend) {
    Mesh mesh = octahedral_sphere(levels);
    const double radius = 4 / bend;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d x = mesh.point(v);
        const double angle = bend * x.z();
        mesh.positions.row(v) << (radius + x.x()) * std::cos(angle) - radius, x.y(), (radius + x.x()) * std::sin(angle);
    }
    return mesh;
}

void unfold(Output& output, Figure& figure, Table& table, const std::string& name, const Mesh& whole, double azimuth,
            double elevation) {
    const Surface source(remove_unreferenced(whole).mesh);
    const int count = source.mesh.vertex_count();
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
    for (int s = 0; s < source.operators.sample_count(); ++s)
        for (const int v : source.operators.stencil(s)) weights[v] += source.operators.weights[s];
    Positions radial = source.mesh.positions;
    radial.rowwise() -= Eigen::RowVector3d((weights.transpose() * radial) / weights.sum());
    const std::optional<Positions> tutte = sphere_tutte(source, tutte_roots(source, 1)[0], weights);
    const SphereTarget target;
    const Eigen::VectorXcd conformal = Eigen::VectorXcd::Zero(source.operators.sample_count());
    for (const bool from_tutte : {false, true}) {
        const TargetMap begin = target_map(source, target, {}, from_tutte ? *tutte : radial);
        const Distortion before = distortion(source.operators, positions_of(begin.points), normals_of(begin.points));
        for (const FlowScheme scheme : {FlowScheme::automatic, FlowScheme::perturbation}) {
            SurfaceFlowOptions options;
            options.scheme = scheme;
            const double start = seconds_now();
            const SurfaceFlowMap flow = surface_flow(source, target, conformal, {}, begin, options);
            std::vector<std::string> row{name, std::to_string(source.mesh.face_count()),
                                         from_tutte ? "Tutte" : "radial", std::to_string(before.flipped.size()),
                                         to_string(scheme)};
            for (std::string& cell : numbers_of(flow, seconds_now() - start)) row.push_back(std::move(cell));
            table.rows.push_back(std::move(row));
            if (from_tutte || scheme != FlowScheme::automatic) continue;
            Picture picture{"flow_" + name, name + ", and its image from an overlapping start.", {}};
            const Positions image = positions_of(flow.map.points);
            add_views(output, picture, "flow_" + name, source.mesh, image, seen_from_south(image),
                      flow.distortion.face_abs_mu, "checker", azimuth, elevation);
            figure.pictures.push_back(std::move(picture));
        }
    }
    const double start = seconds_now();
    const SphereMap uniform = sphere_map(source);
    const Distortion& d = uniform.distortion;
    table.rows.push_back({name, std::to_string(source.mesh.face_count()), "none", "", "uniformization",
                          std::to_string(uniform.iterations), number(d.mean), number(d.standard_deviation),
                          number(d.max), std::to_string(d.flipped.size()), number(seconds_now() - start, 2)});
}

}  // namespace

Figure flow_unfolding(Output& output) {
    Figure figure{"Figures 5.5 to 5.8: conformal maps to the sphere from overlapping starts",
                  "The start is the projection from the centroid, which overlaps, or Tutte's map, which does not. The "
                  "paper's fandisk "
                  "is not at hand."};
    Table table{
        "Nothing is held. Automatic: residual steps while faces are flipped, then perturbations, then against a "
        "barrier",
        {"mesh", "faces", "start", "flipped there", "steps by", "steps", "mean abs(μ)", "std", "max", "flips",
         "seconds"},
        {}};
    unfold(output, figure, table, "bent_capsule", bent_capsule(5, 1.4), 30, 20);
    for (const auto& [name, azimuth, elevation] :
         {std::tuple{"hippocampus.obj", 30.0, 20.0}, {"hand_closed.obj", -90.0, 70.0}, {"fish_quad.obj", 60.0, 20.0}})
        if (const auto path = scan_path(name)) {
            Mesh mesh = read_mesh(*path).mesh;
            unfold(output, figure, table, path->stem().string(), mesh, azimuth, elevation);
        }
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
        "Tolerance 1e-3 both; error: root mean square over the vertices. The paper: 9, 7, 7, 7 steps and 26, 14, 12, —",
        {"vertices", "flow: steps", "seconds a step", "error", "formula: steps", "seconds a step", "error"},
        {}};
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
        if (cells <= 64) {
            start = seconds_now();
            const PerturbationFlow formula = perturbation_flow(source, mu);
            row.insert(row.end(),
                       {std::to_string(formula.iterations) + (formula.converged ? "" : ", not settled"),
                        scientific((seconds_now() - start) / formula.iterations), scientific(error_of(formula.map))});
        } else {
            start = seconds_now();
            PerturbationFlowOptions once;
            once.max_iterations = 1;
            if (cells == 128) perturbation_flow(source, mu, once);
            row.insert(row.end(), {"", cells == 128 ? scientific(seconds_now() - start) : "not run", ""});
        }
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

Figure flow_tori(Output& output) {
    Figure figure{"Figures 5.12 and 5.13: least Lᵖ norm onto the modified tori",
                  "The torus of radii 2 and 1 in a jittered grid of 80 × 40 cells, onto the two modified tori of the "
                  "paper, which takes its kitten; p = 3 "
                  "and 4 are theirs. Start: equal parameters. By the area of the surface no p gives the extremal map; "
                  "by the area |φ| of "
                  "the flat metric already p = 2 does."};
    Table table{"k of the extremal map: .0929 and .2321; |μ| over the area of the source",
                {"target", "weight", "p", "steps", "mean abs(μ)", "std", "max", "flips", "seconds"},
                {}};
    constexpr int kAround = 80, kAcross = 40;
    Mesh mesh = torus(2, 1, kAround, kAcross);
    const ParametricTarget round = torus_target(2, 1);
    Eigen::VectorXcd plane(mesh.vertex_count());
    Random random(1);
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const Complex w((i + random.uniform(-0.2, 0.2)) / kAround, (j + random.uniform(-0.2, 0.2)) / kAcross);
            plane[kAcross * i + j] = w;
            mesh.positions.row(kAcross * i + j) = round.at(w.real(), w.imag()).position;
        }
    const Surface source(mesh);
    const std::vector<double> phi = flat_areas(flat_torus(source), mesh.faces);
    for (const int which : {1, 2}) {
        const ParametricTarget target = which == 1 ? first_modified_torus() : second_modified_torus();
        TargetMap begin;
        for (const Complex w : plane) begin.points.push_back(target.at(w.real(), w.imag()));
        for (const bool by_phi : {false, true})
            for (const double p : {2.0, 3.0, 4.0, 8.0}) {
                const double start = seconds_now();
                const SurfaceFlowMap flow =
                    least_lp_map(source, target, {p, by_phi ? phi : std::vector<double>{}}, {}, begin);
                std::vector<std::string> row{which == 1 ? "first" : "second", by_phi ? "abs(φ)" : "area", number(p, 0)};
                for (std::string& cell : numbers_of(flow, seconds_now() - start)) row.push_back(std::move(cell));
                table.rows.push_back(std::move(row));
                if (by_phi != (which == 2) || p != (which == 1 ? 3 : 4)) continue;
                const std::string name = "flow_torus_" + std::to_string(which);
                Picture picture{name, which == 1 ? "L³ by area onto the first." : "L⁴ by |φ| onto the second.", {}};
                Eigen::VectorXcd waves = plane;
                for (Complex& w : waves)
                    w = {std::sin(2 * std::numbers::pi * w.real()), std::sin(2 * std::numbers::pi * w.imag())};
                add_views(output, picture, name, mesh, positions_of(flow.map.points), waves,
                          flow.distortion.face_abs_mu, "mu", 30, 45);
                figure.pictures.push_back(std::move(picture));
            }
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
