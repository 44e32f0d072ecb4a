// Extremal maps with mixed boundary conditions, as one markdown table: each problem and its inverse, whose k is the
// same.
//
//     bench_mixed [MESHES]        a folder with alex_3.obj
//
// Where k is known in closed form it stands beside the one found, else that of the inverse problem does; both come from
// meshes of their own. K is bracketed by the Reich-Strebel integrals. The error of the map is the largest at a vertex,
// its order that from the row with twice the edges.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include <beltrami/beltrami.h>
#include <beltrami/teichmuller/extremal_mixed.h>

#include "problems/mixed_problems.h"

namespace {

using namespace beltrami;
using bench::MixedProblemCase;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Run {
    MixedProblemCase problem;
    std::optional<ExtremalMap> found;
    std::string refusal;
    double error = 0, seconds = 0;
};

Run run(MixedProblemCase problem) {
    Run result{std::move(problem), {}, {}};
    const double before = now();
    try {
        result.found = mixed_extremal_map(Surface(result.problem.mesh), result.problem.conditions);
    } catch (const Error& failure) {
        result.refusal = failure.what();
    }
    result.seconds = now() - before;
    const auto& exact = result.problem.exact;
    if (result.found && exact) result.error = (result.found->map.head(exact->size()) - *exact).cwiseAbs().maxCoeff();
    return result;
}

void print(const std::string& name, const std::string& h, const Run& run, const Run& other, double last_error) {
    const Mesh& mesh = run.problem.mesh;
    if (!run.found) {
        fmt::print("| {} | {} | {} | {} |\n", name, h, mesh.face_count(), run.refusal);
        return;
    }
    const ExtremalMap& found = *run.found;
    const bool known = run.problem.exact_k.has_value();
    const double reference = known ? *run.problem.exact_k : other.found ? other.found->k : std::nan("");
    fmt::print(
        "| {} | {} | {} | {:.6f} | {:.6f}{} | {:.1e} | {:.4f} to {:.4f} | {:.2f} % | {:.4f} | {:.3f} | {} | {} | {} ",
        name, h, mesh.face_count(), found.k, reference, known ? "" : " (inverse)", std::abs(found.k - reference),
        found.K_lower, found.K_upper, 100 * (found.K_upper / found.K_lower - 1), found.distortion.standard_deviation,
        found.distortion.max, found.iterations, found.distortion.flipped.size(), found.dimension);
    const std::string order = last_error > 0 ? fmt::format("{:.2f}", std::log2(last_error / run.error)) : "";
    fmt::print("| {} | {} | {:.2f} |\n", run.error > 0 ? fmt::format("{:.1e}", run.error) : "", order, run.seconds);
    for (const Warning& warning : found.warnings) fmt::print(stderr, "{}, {}: {}\n", name, h, warning.sentence);
    std::fflush(stdout);
}

/// Both ways, for edge lengths that are halved from row to row.
void print(const std::function<MixedProblemCase(double h, bool back)>& make, const std::vector<double>& edges) {
    std::map<bool, double> last_error;
    for (const double h : edges) {
        const Run there = run(make(h, false)), back = run(make(h, true));
        const std::string name = there.problem.name, edge = fmt::format("{}", h);
        print(name, edge, there, back, last_error[false]);
        print(name + ", inverse", edge, back, there, last_error[true]);
        last_error = {{false, there.error}, {true, back.error}};
    }
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| problem | h | faces | k | exact | difference | bracket of K | gap | std | max abs mu | iterations | flips | "
        "dimension | error of the map | order | seconds |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    const std::vector<double> edges{0.08, 0.04, 0.02};
    print(bench::sliding_inner_circle, edges);
    print(bench::two_sliding_sides, edges);
    print(bench::sliding_half_circle, edges);
    for (const bool pinned : {false, true})
        print([=](double h, bool back) { return bench::two_prescribed_arcs(h, back, pinned); }, edges);
    for (const int pins : {2, 3, 5})
        print([=](double h, bool back) { return bench::pins_in_sliding_disk(h, pins, back); }, edges);
    for (const bool pinned : {false, true})
        print([=](double h, bool back) { return bench::two_sliding_holes(h, back, pinned); }, edges);
    const auto face = std::filesystem::path(argc > 1 ? argv[1] : "../shared/meshes") / "alex_3.obj";
    if (std::filesystem::exists(face)) {
        const Mesh mesh = read_mesh(face).mesh;
        print([&](double h, bool back) { return bench::sliding_holes_of_face(mesh, h, back); }, {0.02});
    }
    return 0;
}
