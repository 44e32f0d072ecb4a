// All methods on the same boundary values, as one markdown table.
//
//     bench_methods [MESHES]      a folder with mcqc2d_planar_src.obj and the like
//
// Times are those of the JSON record, in harmonic maps of the same mesh measured in the same run; k is that of the
// method where it has one, else empty. LSCM has no line: with the whole boundary prescribed it is the harmonic map, and
// with a free one the identity of these planar sources. A method that refuses a case with an Error has a line that says
// so.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/linear/linear_backend.h>
#include <beltrami/report/timing.h>

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Case {
    std::string name;
    Surface source;
    BoundaryCondition boundary;
};

/// Boundary values as a function of the loop and the point.
BoundaryCondition prescribe(const Surface& source, const std::function<Complex(int loop, Complex)>& image) {
    BoundaryCondition boundary;
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l)
        for (const int v : source.topology.boundary_loops[l])
            boundary.pin(v, image(static_cast<int>(l), {source.mesh.positions(v, 0), source.mesh.positions(v, 1)}));
    return boundary;
}

Case made(std::string name, Mesh mesh, const std::function<Complex(int, Complex)>& image) {
    Surface source(std::move(mesh));
    BoundaryCondition boundary = prescribe(source, image);
    return {std::move(name), std::move(source), std::move(boundary)};
}

/// exp(0.6(g + ½ ḡ)), g = z + 0.3 z²: k = ½.
Case composition() {
    return made("exact composition, k = .5", disk(disk_rings_for_triangles(4478)), [](int, Complex z) {
        const Complex g = z + 0.3 * z * z;
        return std::exp(0.6 * (g + 0.5 * std::conj(g)));
    });
}

Case three_lobes() {
    return made("disk to three lobes", disk(disk_rings_for_triangles(10'000)), [](int, Complex z) {
        const double t = std::arg(z);
        return std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
    });
}

/// The outer circle stays; the hole is moved, shrunk and turned by 0.8 rad.
Case moved_hole() {
    DomainOptions options;
    options.edge_length = 0.035;
    options.hole_edge_length = 0.025;
    return made(
        "annulus, hole moved, shrunk and turned", circle_domain({}, {{{0, 0}, 0.4}}, options),
        [](int loop, Complex z) { return loop == 0 ? z : Complex(0.25, 0.1) + 0.6 * std::polar(1.0, 0.8) * z; });
}

/// The unit square with its corner (1, 1) pushed in along the diagonal, sides sent affinely.
Case arrow_head() {
    DomainOptions options;
    options.edge_length = 0.025;
    const double pushed = 1 - 0.45;
    return made("square to arrow-head, corner pushed in by .45",
                polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, options), [&](int, Complex z) {
                    const double x = z.real(), y = z.imag();
                    if (x > 1 - 1e-12) return Complex(1 + (pushed - 1) * y, pushed * y);
                    if (y > 1 - 1e-12) return Complex(pushed * x, 1 + (pushed - 1) * x);
                    return z;
                });
}

std::optional<Case> pinned(const std::filesystem::path& folder, const std::string& name) {
    const std::filesystem::path mesh = folder / (name + "_planar_src.obj");
    if (!std::filesystem::exists(mesh)) return {};
    BoundaryCondition boundary;
    std::ifstream pins(folder / (name + "_pins.txt"));
    int vertex;
    double x, y;
    while (pins >> vertex >> x >> y) boundary.pin(vertex, {x, y});
    return Case{name, Surface(read_mesh(mesh).mesh), std::move(boundary)};
}

struct Outcome {
    Distortion distortion;
    std::optional<double> k;
    std::string termination;
};

Outcome baseline(const Case& c, const BaselineMap& result) {
    return {distortion(c.source.operators, result.map),
            {},
            fmt::format("{}, {}", result.converged ? "converged" : "iteration_limit", result.iterations)};
}

struct Method {
    const char* name;
    std::function<Outcome(const Case&)> run;
};

const std::vector<Method>& methods() {
    static const std::vector<Method> all{
        {"harmonic", [](const Case& c) { return baseline(c, harmonic_baseline(c.source, c.boundary)); }},
        {"arap", [](const Case& c) { return baseline(c, arap_baseline(c.source, c.boundary)); }},
        {"mips", [](const Case& c) { return baseline(c, mips_baseline(c.source, c.boundary)); }},
        {"alternation", [](const Case& c) { return baseline(c, alternation_baseline(c.source, c.boundary)); }},
        {"qc", [](const Case& c) { return baseline(c, qc_iteration_baseline(c.source, c.boundary)); }},
        {"qc, arg μ not smoothed",
         [](const Case& c) {
             BaselineOptions options;
             options.smoothing = 0;
             return baseline(c, qc_iteration_baseline(c.source, c.boundary, options));
         }},
        {"extremal", [](const Case& c) {
             const ExtremalMap result = extremal_map(c.source, c.boundary);
             return Outcome{result.distortion, result.k,
                            fmt::format("{}, {}", to_string(result.termination), result.iterations)};
         }}};
    return all;
}

void measure(const Case& c) {
    const double harmonic = harmonic_seconds(c.source, c.boundary);
    for (const Method& method : methods()) {
        const std::string start = fmt::format("| {} | {} | {} |", c.name, c.source.mesh.face_count(), method.name);
        try {
            const double before = now();
            const Outcome outcome = method.run(c);
            const double seconds = now() - before;
            const Distortion& d = outcome.distortion;
            fmt::print("{} {} | {:.5f} | {:.4f} | {:.4f} | {:.4f} | {} | {:.1f} | {} |\n", start,
                       outcome.k ? fmt::format("{:.5f}", *outcome.k) : "", d.mean, d.standard_deviation, d.p99, d.max,
                       d.flipped.size(), seconds / harmonic, outcome.termination);
        } catch (const Error& error) {
            std::fprintf(stderr, "%s, %s: %s\n", c.name.c_str(), method.name, error.what());
            fmt::print("{}  |  |  |  |  |  |  | refused |\n", start);
        }
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    fmt::print(
        "{}\n\n| case | triangles | method | k | mean | std | p99 | max | flips | time | termination, iterations |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        linear_backend());
    measure(composition());
    measure(three_lobes());
    measure(moved_hole());
    measure(arrow_head());
    for (const char* name : {"mcqc2d", "mcqc3d"})
        if (const std::optional<Case> c = pinned(folder, name)) measure(*c);
}
