#include <beltrami/base/error.h>
#include <beltrami/solve/beltrami_solver.h>

#include <algorithm>
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
        result.distortion = result.all ? result.all->distortion : distortion(surface.operators, result.map);
    } catch (const Error& error) {
        result.map.resize(0);
        result.refusal = error.what();
    }
    return result;
}

}  // namespace

Solved solve(const Surface& surface, const Constraints& constraints, const std::string& method,
             ExtremalOptions options) {
    if (!options.sharpen) options.sharpen = 0;
    const BoundaryCondition& boundary = constraints.prescribed;
    return run(surface, method, [&](Solved& result) {
        const auto take = [&](BaselineMap found) {
            result.map = std::move(found.map);
            result.iterations = found.iterations;
        };
        if (method == "extremal" || method == "not evened") {
            if (method == "not evened") options.evening = ExtremalOptions::Evening::never;

            result.all = extremal_map(surface, constraints, options);
            const ExtremalMap& found = *result.all;
            result.map = found.map;
            result.k = found.k;
            result.K = found.K;
            result.K_lower = found.K_lower;
            result.iterations = found.iterations;
            result.end = found.termination == Termination::converged         ? "converged"
                         : found.termination == Termination::not_teichmuller ? "not Teichmüller"
                         : found.termination == Termination::below_bound     ? "below the proved bound"
                         : found.termination == Termination::unconfirmed     ? "not confirmed"
                                                                             : "iteration limit";
        } else if (method == "harmonic") {
            result.map = harmonic_map(surface, boundary);  // lines too, unlike the baseline
        } else if (method == "ARAP") {
            take(arap_baseline(surface, boundary));
        } else if (method == "MIPS") {
            take(mips_baseline(surface, boundary));
        } else if (method == "least maximum") {
            LeastMaximumOptions least;
            least.extremal = options;
            LeastMaximumMap found = least_maximum_map(surface, constraints, least);
            if (found.split && found.split->split_edges > 0) throw Error(Cause::not_solved, "edges had to be split");
            result.map = std::move(found.map);
            result.iterations = found.iterations;
            // Bounds of the extremal map it starts from: of the class.
            if (found.extremal) result.K_lower = found.extremal->K_lower;
        } else {
            throw Error(Cause::bad_option, "there is no method " + method);
        }
    });
}

double harmonic_seconds(const Surface& surface, const BoundaryCondition& boundary) {
    double best = 1e300;
    for (int i = 0; i < 3; ++i)
        best = std::min(best, run(surface, "harmonic", [&](Solved& result) {
                                  result.map = harmonic_map(surface, boundary);
                              }).seconds);
    return best;
}

Solved solve_with(const Surface& surface, const std::string& method, const std::function<Eigen::VectorXcd()>& map) {
    return run(surface, method, [&](Solved& result) { result.map = map(); });
}

}  // namespace beltrami::gallery
