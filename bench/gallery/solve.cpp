#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/mesh/error.h>

#include <chrono>

#include "gallery/gallery.h"

namespace beltrami::gallery {

namespace {

/// Runs a solver, which fills in what it knows, and measures its map.
Solved run(const Surface& surface, const std::string& method, const std::function<void(Solved&)>& solver) {
    Solved result;
    result.method = method;
    const auto start = std::chrono::steady_clock::now();
    try {
        solver(result);
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        result.distortion = distortion(surface.operators, result.map);
    } catch (const Error& error) {
        result.map.resize(0);
        result.refusal = error.what();
    }
    return result;
}

}  // namespace

Solved solve(const Surface& surface, const BoundaryCondition& boundary, const std::string& method) {
    return run(surface, method, [&](Solved& result) {
        const auto take = [&](BaselineMap found) {
            result.map = std::move(found.map);
            result.iterations = found.iterations;
        };
        if (method == "extremal") {
            ExtremalMap found = extremal_map(surface, boundary);
            result.map = std::move(found.map);
            result.k = found.k;
            result.K_lower = found.K_lower;
            result.iterations = found.iterations;
        } else if (method == "harmonic") {
            take(harmonic_baseline(surface, boundary));
        } else if (method == "ARAP") {
            take(arap_baseline(surface, boundary));
        } else if (method == "MIPS") {
            take(mips_baseline(surface, boundary));
        } else {
            throw Error(Cause::bad_option, "there is no method " + method);
        }
    });
}

Solved solve_with(const Surface& surface, const std::string& method, const std::function<Eigen::VectorXcd()>& map) {
    return run(surface, method, [&](Solved& result) { result.map = map(); });
}

}  // namespace beltrami::gallery
