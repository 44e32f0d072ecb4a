// Boundary conditions that mix: each problem and its inverse.
#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/teichmuller/extremal_mixed.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gallery/sliding.h"
#include "problems/mixed_problems.h"

namespace beltrami::gallery {

namespace {

using bench::MixedProblemCase;
using Make = std::function<MixedProblemCase(double h, bool back)>;

constexpr double kEdge = 0.02;

struct SolvedMixed {
    MixedProblemCase problem;
    std::optional<ExtremalMap> found;
    std::string refusal;
    double error = 0;  ///< of the map, the largest at a vertex; where it is known
};

SolvedMixed solved(MixedProblemCase problem) {
    SolvedMixed result{std::move(problem), {}, {}};
    try {
        result.found = mixed_extremal_map(Surface(result.problem.mesh), result.problem.conditions);
        if (const auto& exact = result.problem.exact)
            result.error = (result.found->map.head(exact->size()) - *exact).cwiseAbs().maxCoeff();
    } catch (const Error& error) {
        result.refusal = error.what();
    }
    return result;
}

/// @param other the inverse problem's; @param coarse_error with edges twice as long, or 0
std::vector<std::string> row_of(const std::string& name, const SolvedMixed& one, const SolvedMixed& other,
                                double coarse_error) {
    const std::string faces = std::to_string(one.problem.mesh.face_count());
    if (!one.found) return {name, faces, "refused: " + one.refusal};
    const ExtremalMap& found = *one.found;
    const Distortion& d = found.distortion;
    std::string known, difference;
    if (one.problem.exact_k) {
        known = number(*one.problem.exact_k, 6);
        difference = fmt::format("{:.1e}", std::abs(found.k - *one.problem.exact_k));
    } else if (other.found) {
        known = "inverse: " + number(other.found->k, 6);
        difference = fmt::format("{:.1e}", std::abs(found.k - other.found->k));
    }
    return {name,
            faces,
            known,
            number(found.k, 6),
            difference,
            number(found.K_lower) + " to " + number(found.K_upper),
            fmt::format("{:.2f} %", 100 * (found.K_upper / found.K_lower - 1)),
            number(d.standard_deviation),
            number(d.max, 3),
            std::to_string(d.flipped.size()),
            std::to_string(found.iterations),
            one.error > 0 ? fmt::format("{:.1e}", one.error) : "",
            coarse_error > 0 ? number(std::log2(coarse_error / one.error), 2) : ""};
}

Picture picture_of(Output& output, const std::string& name, const SolvedMixed& one) {
    const ExtremalMap& found = *one.found;
    const Mesh& mesh = found.split ? found.split->mesh : one.problem.mesh;
    const std::string data = output.write(name, mesh, found.map, found.distortion.face_abs_mu);
    const double shown = std::min(1.0, 1.6 * found.k);
    Picture picture{name, one.problem.name + ": k = " + number(found.k, 5) + ".", {}};
    if (is_planar(one.problem.mesh)) {
        picture.panels.push_back(circles_panel(data, "source", "source", 26));
        picture.panels.push_back(map_panel(data, "source, |μ|", shown, "source"));
    } else {
        picture.panels.push_back(surface_panel(data, "source", "circles", 0, 90, 26));
        picture.panels.push_back(surface_panel(data, "source, |μ|", "mu", 0, 90, 26, shown));
    }
    picture.panels.push_back(map_panel(data, "image, |μ|", shown));
    picture.panels.push_back(histogram_panel({{"", data}}, "", found.k, shown));
    return picture;
}

void add(Output& output, Figure& figure, const std::string& name, const Make& make) {
    const SolvedMixed there = solved(make(kEdge, false)), back = solved(make(kEdge, true));
    // Errors of twice the edges, for the order.
    const auto coarse_error = [&](const SolvedMixed& fine, bool is_back) {
        return fine.error > 0 ? solved(make(2 * kEdge, is_back)).error : 0.0;
    };
    Table& table = figure.tables.front();
    table.rows.push_back(row_of(there.problem.name, there, back, coarse_error(there, false)));
    table.rows.push_back(row_of("… inverse", back, there, coarse_error(back, true)));
    if (there.found) figure.pictures.push_back(picture_of(output, "sliding_mixed_" + name, there));
}

}  // namespace

Figure sliding_mixed(Output& output) {
    Figure figure{"Boundary conditions that mix",
                  "Not in the paper: some loops or arcs of loops are prescribed, others slide along curves, and inner "
                  "points are pinned ([conditions that mix](mixed.md))."};
    figure.tables.push_back(
        {"h = .02, meshes graded to pins and to where the condition changes. A map and its inverse "
         "have the same k; both are solved on meshes of their own. The error of the map is the "
         "largest at a vertex, its order that from h = .04",
         {"problem", "triangles", "known k", "k", "difference", "bracket of K", "gap", "std", "max abs(μ)", "flips",
          "iterations", "error of the map", "order"},
         {}});
    add(output, figure, "ring", bench::sliding_inner_circle);
    add(output, figure, "square", bench::two_sliding_sides);
    add(output, figure, "half_circle", bench::sliding_half_circle);
    for (const bool pinned : {false, true})
        add(output, figure, pinned ? "arcs_and_pin" : "arcs",
            [=](double h, bool back) { return bench::two_prescribed_arcs(h, back, pinned); });
    for (const int pins : {2, 3, 5})
        add(output, figure, fmt::format("pins_{}", pins),
            [=](double h, bool back) { return bench::pins_in_sliding_disk(h, pins, back); });
    for (const bool pinned : {false, true})
        add(output, figure, pinned ? "holes_and_pin" : "holes",
            [=](double h, bool back) { return bench::two_sliding_holes(h, back, pinned); });
    if (const auto file = scan_path("alex_3.obj")) {
        const Mesh face = read_mesh(*file).mesh;
        add(output, figure, "face", [&](double h, bool back) { return bench::sliding_holes_of_face(face, h, back); });
    }
    return figure;
}

}  // namespace beltrami::gallery
