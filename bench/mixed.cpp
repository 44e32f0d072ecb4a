// Extremal maps with mixed boundary conditions, as one markdown table.
//
//     bench_mixed [MESHES]        a folder with alex_3.obj
//
// Problems whose k is known in closed form come at three edge lengths, with the error of the map where that is known
// too; others both ways: a map and its inverse have the same k. K is bracketed by the Reich-Strebel integrals.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include <beltrami/beltrami.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/teichmuller/extremal_mixed.h>

#include "problems/mixed_problems.h"

namespace {

using namespace beltrami;
using bench::MixedProblemCase;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print(const std::string& name, const std::string& h, const Surface& source, const MixedConditions& conditions,
           const std::optional<double>& exact_k = {}, const std::optional<Eigen::VectorXcd>& exact = {}) {
    const double before = now();
    try {
        const ExtremalMap found = mixed_extremal_map(source, conditions);
        const double seconds = now() - before;
        const std::string error =
            exact ? fmt::format("{:.1e}", (found.map.head(exact->size()) - *exact).cwiseAbs().maxCoeff()) : "";
        fmt::print(
            "| {} | {} | {} | {:.6f} | {} | {:.4f}–{:.4f} | {:.4f} | {:.3f} | {} | {} | {} | {} | {} | {:.0e} | {:.2f} "
            "|\n",
            name, h, source.mesh.face_count(), found.k,
            exact_k ? fmt::format("{:.1e}", std::abs(found.k - *exact_k)) : "", found.K_lower, found.K_upper,
            found.distortion.standard_deviation, found.distortion.max, error,
            fmt::format("{}{}", found.start_flips, found.start_unfolded ? " (opened)" : ""),
            found.distortion.flipped.size(), found.iterations, found.dimension, found.reality, seconds);
        for (const std::string& warning : found.warnings) fmt::print(stderr, "{}: {}\n", name, warning);
    } catch (const Error& failure) {
        fmt::print("| {} | {} | {} | {} |\n", name, h, source.mesh.face_count(), failure.what());
    }
    std::fflush(stdout);
}

void print(const MixedProblemCase& problem, const std::string& h, const std::string& more = "") {
    print(problem.name + more, h, Surface(problem.mesh), problem.conditions, problem.exact_k, problem.exact);
}

/// A scanned face: its outline to the disk, three holes slide onto the circles of its own circle domain, put where the
/// outline takes them.
void print_scan(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return;
    const Surface source(read_mesh(file).mesh);
    MixedConditions conditions;
    conditions.prescribed = boundary_to_disk(source, 0.5);
    const CircleDomainChart chart = circle_domain_chart(source);
    Complex turn = 0;
    for (std::size_t i = 0; i < conditions.prescribed.vertices.size(); ++i)
        turn += conditions.prescribed.images[i] * std::conj(chart.chart.vertices[conditions.prescribed.vertices[i]]);
    turn /= std::abs(turn);
    conditions.curves.resize(source.topology.boundary_loops.size());
    for (const RoundHole& hole : chart.holes)
        conditions.curves[hole.loop] = TargetCurve::circle(turn * hole.centre, hole.radius);
    print("face alex_3, outline prescribed (disk:0.5), holes slide", "", source, conditions);
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| problem | h | triangles | k | error of k | K between | std | max abs mu | error of the map | flips at the "
        "start "
        "| flips | iterations | dimension | not real | seconds "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const double h : {0.08, 0.04, 0.02}) print(bench::sliding_inner_circle(h), fmt::format("{}", h));
    for (const double h : {0.08, 0.04, 0.02}) print(bench::two_sliding_sides(h), fmt::format("{}", h));
    for (const double h : {0.08, 0.04, 0.02}) print(bench::sliding_half_circle(h), fmt::format("{}", h));
    for (const double h : {0.08, 0.04, 0.02}) print(bench::pins_in_sliding_disk(h, 2, false), fmt::format("{}", h));
    for (const double h : {0.08, 0.04})
        for (const bool back : {false, true}) {
            const std::string more = back ? ", back" : "", edge = fmt::format("{}", h);
            print(bench::pins_in_sliding_disk(h, 3, back), edge, more);
            print(bench::pins_in_sliding_disk(h, 5, back), edge, more);
            print(bench::two_sliding_holes(h, back, false), edge, more);
            print(bench::two_sliding_holes(h, back, true), edge, ", a pin inside" + more);
            print(bench::two_prescribed_arcs(h, back, false), edge, more);
            print(bench::two_prescribed_arcs(h, back, true), edge, ", a pin inside" + more);
        }
    print_scan(std::filesystem::path(argc > 1 ? argv[1] : "../shared/meshes") / "alex_3.obj");
    return 0;
}
