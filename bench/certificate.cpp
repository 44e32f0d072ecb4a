// The tables of the certificate: pair bounds under refinement, and proved brackets.
//
//     bench_certificate [FOLDER] [GAP]
//
// FOLDER holds bump8.obj, cert1.obj and cert1.pin, whose rows are left out where it is not given. GAP is the part of K
// that brackets are to have, .01 by default.

#include <chrono>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/beltrami.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/solve/dirichlet_solver.h>

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Case {
    std::string name;
    Surface surface;
    BoundaryCondition boundary;
};

double largest(const std::vector<Bound>& bounds, Bound::Kind kind) {
    double K = 1;
    for (const Bound& bound : bounds)
        if (bound.kind == kind) K = std::max(K, bound.K);
    return K;
}

double harmonic_seconds(const Case& c) {
    const double start = now();
    dirichlet_solver(c.surface).solve(prescribed_values(c.boundary, c.surface));
    return now() - start;
}

/// Reich-Strebel's and the pair bound on finer and finer meshes.
void pair_rows(Case c, int refinements) {
    for (int level = 0; level <= refinements; ++level) {
        if (level > 0) {
            RefinedProblem fine = refined_problem(c.surface, c.boundary);
            c.surface = std::move(fine.surface);
            c.boundary = std::move(fine.boundary);
        }
        ExtremalOptions options;
        options.prove = true;
        const ExtremalMap result = extremal_map(c.surface, c.boundary, options);
        const auto image = image_under(c.surface, result.map.head(c.surface.mesh.vertex_count()));
        const double start = now();
        const int steps = image ? pair_bound(c.surface, *image).steps : 0;
        const double seconds = now() - start;
        fmt::print("| {} | {} | {:.5f} | {:.5f} | {:.5f} | {} | {:.1f} |\n", c.name, c.surface.mesh.face_count(),
                   largest(result.bounds, Bound::Kind::reich_strebel), largest(result.bounds, Bound::Kind::pair),
                   largest(result.bounds, Bound::Kind::edge_corner), steps, seconds / harmonic_seconds(c));
        std::fflush(stdout);
    }
}

void bracket_row(const Case& c, double gap) {
    const double start = now();
    const Certification done = certify(c.surface, c.boundary, gap);
    fmt::print("| {} | {} | {:.5f} | {:.5f} | {:.2f} % | {} | {} | {:.1f} | {} |\n", c.name,
               c.surface.mesh.face_count(), done.result.K_lower_proved, done.K_upper, 100 * done.gap,
               done.proof_triangles, done.refinements, now() - start, done.reached ? "proved" : "not proved");
    std::fflush(stdout);
}

template <class Function>
BoundaryCondition rim_values(const Surface& surface, const Function& f) {
    BoundaryCondition boundary;
    for (const auto& loop : surface.topology.boundary_loops)
        for (const int v : loop)
            boundary.pin(v, f(Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1))));
    return boundary;
}

Case composition(int rings) {
    Surface surface(disk(rings));
    BoundaryCondition boundary = rim_values(surface, [](Complex z) {
        const Complex g = z + 0.3 * z * z;
        return std::exp(0.6 * (g + 0.5 * std::conj(g)));
    });
    return {"exact composition", std::move(surface), std::move(boundary)};
}

Case lobes(int rings) {
    Surface surface(disk(rings));
    BoundaryCondition boundary = rim_values(surface, [](Complex z) {
        const double t = std::arg(z);
        return std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
    });
    return {"three lobes", std::move(surface), std::move(boundary)};
}

/// The unit square kept at its boundary, the middle moved by (.12, .08).
Case pinned_square(int n) {
    Mesh mesh;
    mesh.positions.resize((n + 1) * (n + 1), 2);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            mesh.positions.row(j * (n + 1) + i) << static_cast<double>(i) / n, static_cast<double>(j) / n;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            mesh.faces.add({a, b, c});
            mesh.faces.add({a, c, d});
        }
    Surface surface(std::move(mesh));
    BoundaryCondition boundary = rim_values(surface, [](Complex z) { return z; });
    boundary.pin(n / 2 * (n + 1) + n / 2, Complex(0.62, 0.58));
    return {"pinned square", std::move(surface), std::move(boundary)};
}

/// Two triangles folded in space, to the unit square.
Case two_triangles() {
    Mesh mesh;
    mesh.positions.resize(4, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    BoundaryCondition boundary;
    const Complex corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int v = 0; v < 4; ++v) boundary.pin(v, corners[v]);
    return {"two", Surface(std::move(mesh)), std::move(boundary)};
}

Case cert1(const std::string& folder) {
    Surface surface(read_mesh(folder + "/cert1.obj").mesh);
    BoundaryCondition boundary;
    std::ifstream file(folder + "/cert1.pin");
    for (std::string line; std::getline(file, line);) {
        line = line.substr(0, line.find('#'));
        std::istringstream words(line);
        int v;
        double x, y;
        if (words >> v >> x >> y) boundary.pin(v, {x, y});
    }
    return {"cert1", std::move(surface), std::move(boundary)};
}

/// Onto the unit square, by arc length between four corners.
Case bump8(const std::string& folder) {
    Surface surface(read_mesh(folder + "/bump8.obj").mesh);
    const auto& loop = surface.topology.boundary_loops[0];
    const auto& lengths = surface.boundary_edge_lengths[0];
    const int n = static_cast<int>(loop.size());
    const int corners[] = {0, 8, 80, 72};
    const Complex images[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    BoundaryCondition boundary;
    const auto position = [&](int v) {
        return static_cast<int>(std::find(loop.begin(), loop.end(), v) - loop.begin());
    };
    for (int side = 0; side < 4; ++side) {
        const int from = position(corners[side]);
        int to = position(corners[(side + 1) % 4]);
        if (to <= from) to += n;
        double length = 0, at = 0;
        for (int p = from; p < to; ++p) length += lengths[p % n];
        for (int p = from; p < to; at += lengths[p % n], ++p)
            boundary.pin(loop[p % n], images[side] + (images[(side + 1) % 4] - images[side]) * (at / length));
    }
    return {"bump8", std::move(surface), std::move(boundary)};
}

void run(const std::string& folder, double gap) {
    fmt::print(
        "| case | triangles | Reich-Strebel | pair | one-edge corner | steps | harmonic maps |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    pair_rows(composition(8), 2);
    pair_rows(lobes(14), 1);
    pair_rows(two_triangles(), 6);
    if (!folder.empty()) {
        pair_rows(cert1(folder), 3);
        pair_rows(bump8(folder), 3);
    }
    fmt::print(
        "\n| case | triangles | K_lower_proved | K_upper | gap | triangles of the proof | refinements | seconds | |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const int rings : {8, 14, 27}) bracket_row(composition(rings), gap);
    for (const int rings : {14, 27}) bracket_row(lobes(rings), gap);
    for (const int n : {16, 26}) bracket_row(pinned_square(n), gap);
    bracket_row(two_triangles(), gap);
    if (!folder.empty()) {
        bracket_row(cert1(folder), gap);
        bracket_row(bump8(folder), gap);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(argc > 1 ? argv[1] : "", argc > 2 ? std::stod(argv[2]) : 0.01);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
