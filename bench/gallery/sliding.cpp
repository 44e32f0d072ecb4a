#include "gallery/sliding.h"

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/targets/target_mesh.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace beltrami::gallery {

Mesh disk_with_holes(const std::vector<Hole>& holes, double h, int least_vertices) {
    std::vector<Circle> circles;
    for (const auto& [x, y, r] : holes) circles.push_back({{x, y}, r});
    DomainOptions options;
    options.edge_length = h;
    options.hole_edge_length = 0.4 * h;
    options.least_hole_edges = least_vertices;
    return circle_domain({Eigen::Vector2d::Zero(), 1}, circles, options);
}

TargetDomain circles_target(const std::vector<Hole>& holes) {
    std::vector<TargetCurve> curves;
    for (const auto& [x, y, r] : holes) curves.push_back(TargetCurve::circle({x, y}, r));
    return target_domain(TargetCurve::circle(0, 1), std::move(curves));
}

Mesh domain_mesh(const TargetDomain& domain, double h, double hole_h) {
    TargetMeshOptions options;
    options.edge_length = h;
    options.hole_edge_length = hole_h;
    return target_mesh(domain, options).mesh;
}

TargetCurve polar_spline(Complex centre, const std::function<double(double)>& radius, int points) {
    std::vector<Complex> places;
    for (int i = 0; i < points; ++i) {
        const double t = 2 * std::numbers::pi * i / points;
        places.push_back(centre + std::polar(radius(t), t));
    }
    return TargetCurve::spline(places);
}

Correspondence numbered(std::size_t holes) {
    Correspondence wanted;
    for (int l = 0; l <= static_cast<int>(holes); ++l) wanted.loops.push_back({l, l});
    return wanted;
}

SolvedOnto solve_onto(const Surface& source, const Constraints& onto, const ExtremalOptions& options) {
    return solve_onto([&] { return extremal_map(source, onto, options); });
}

SolvedOnto solve_onto(const std::function<ExtremalMap()>& solver) {
    SolvedOnto result;
    const auto start = std::chrono::steady_clock::now();
    try {
        result.all = solver();
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    } catch (const Error& error) {
        result.refusal = error.what();
    }
    return result;
}

std::string write(Output& output, const std::string& name, const Surface& source, const SolvedOnto& solved) {
    return output.write(name, solved.mesh(source), solved.all->map, solved.all->distortion.face_abs_mu);
}

std::vector<std::string> onto_head(const std::string& first) {
    return {first, "triangles", "known k", "k",     "bracket of k", "mean abs(μ)",
            "std", "p99",       "max",     "flips", "iterations",   "seconds"};
}

std::vector<std::string> onto_row(const std::string& first, const Surface& source, const std::string& known,
                                  const SolvedOnto& solved) {
    if (!solved) return {first, std::to_string(source.mesh.face_count()), known, "refused: " + solved.refusal};
    const ExtremalMap& found = *solved.all;
    const Distortion& d = found.distortion;
    return {first,
            std::to_string(solved.mesh(source).face_count()),
            known,
            number(found.k, 5),
            number(k_of(found.K_lower), 5) + " to " + number(k_of(found.K_upper), 5),
            number(d.mean),
            number(d.standard_deviation),
            number(d.p99),
            number(d.max, 3),
            std::to_string(d.flipped.size()),
            std::to_string(found.iterations) + (found.termination == Termination::converged ? "" : " (not settled)"),
            number(solved.seconds, 2)};
}

std::vector<Curve> correspondences(const Surface& source, const TargetDomain& target, const ExtremalMap& map) {
    std::vector<Curve> result;
    for (const LoopOnto& onto : map.loops) {
        const std::vector<double>&lengths = source.boundary_edge_lengths[onto.loop], &parameters = onto.parameters;
        const std::size_t n = lengths.size();
        if (parameters.size() != n) continue;
        double whole = 0;
        for (const double length : lengths) whole += length;
        Curve curve{onto.curve == 0 ? "outer curve" : "hole " + std::to_string(onto.curve), {}, {}};
        double at = 0;
        for (std::size_t i = 0; i < n; ++i) {
            curve.x.push_back(at / whole);
            curve.y.push_back((parameters[i] - parameters[0]) / target.curve(onto.curve).length());
            at += lengths[i];
        }
        curve.x.push_back(1);
        curve.y.push_back(1);
        result.push_back(std::move(curve));
    }
    return result;
}

SolvedOnto OntoExample::run(Output& output, Figure& figure, Table& table, const Surface& source,
                            const TargetDomain& target, const Correspondence& wanted) const {
    SolvedOnto solved = solve_onto(source, {target, wanted});
    table.rows.push_back(onto_row(caption, source, known, solved));
    if (!solved) return solved;
    const double shown = std::min(1.0, 1.6 * solved.all->k);
    const std::string data = write(output, name, source, solved);
    Picture picture{name, caption + ".", {}};
    picture.panels.push_back(circles_panel(data, "source", "source", circles, segments));
    picture.panels.push_back(circles_panel(data, "image", "image", circles, segments));
    picture.panels.push_back(map_panel(data, "|μ|", shown));
    picture.panels.push_back(histogram_panel({{"", data}}, "", solved.all->k, shown));
    picture.panels.push_back(curves_panel(correspondences(source, target, *solved.all), "boundary correspondence",
                                          "arc length, source", "arc length, image", false));
    figure.pictures.push_back(std::move(picture));
    return solved;
}

Energies energies(const std::string& label, const Surface& source, const Constraints& onto, ExtremalOptions options) {
    Energies result{{label, {}, {}}, {label, {}, {}}};
    const auto add = [&](int iterations, const Distortion& d) {
        result.largest.x.push_back(iterations);
        result.largest.y.push_back(std::min(1.0, d.max));
        result.p99.x.push_back(iterations);
        result.p99.y.push_back(std::min(1.0, d.p99));
    };
    options.remove_folds = false;
    options.coarse_start = false;
    for (int n = 1; n <= 90 && result.settled == 0; n += n < 20 ? 1 : 5) {
        options.max_iterations = n;
        const SolvedOnto solved = solve_onto(source, onto, options);
        if (!solved) continue;
        if (result.p99.x.empty()) add(0, distortion(source.operators, solved.all->start));
        add(solved.all->iterations, solved.all->distortion);
        if (solved.all->termination == Termination::converged) result.settled = solved.all->iterations;
    }
    return result;
}

std::optional<std::filesystem::path> scan_path(const std::string& file) {
    const char* folder = std::getenv("BELTRAMI_MESHES");
    const std::filesystem::path path = std::filesystem::path(folder ? folder : "") / file;
    if (folder && *folder && std::filesystem::exists(path)) return path;
    fmt::print(stderr, "{} is not in the folder BELTRAMI_MESHES; what needs it is left out\n", file);
    return {};
}

}  // namespace beltrami::gallery
