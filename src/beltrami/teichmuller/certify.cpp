#include <beltrami/teichmuller/certify.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>

namespace beltrami {

namespace {

/// The space may grow on a finer mesh while that raises k by more than this part of the wanted gap.
constexpr double kGrowthOfGap = 1e-3;

/// Infinite without a Reich-Strebel bound.
double gap_of(const ExtremalMap& map) {
    const bool bounded = std::any_of(map.bounds.begin(), map.bounds.end(),
                                     [](const Bound& bound) { return bound.kind == "reich_strebel"; });
    return bounded ? map.K / map.K_lower - 1 : std::numeric_limits<double>::infinity();
}

/// The best bounds of all meshes, with the estimate of the mesh that has the largest.
void take_over(ExtremalMap& result, const ExtremalMap& finer) {
    const auto best_of = [](const ExtremalMap& map, bool rigorous) {
        const Bound* best = nullptr;
        for (const Bound& bound : map.bounds)
            if (bound.kind == "reich_strebel" && (bound.rigorous || !rigorous) && (!best || bound.K > best->K))
                best = &bound;
        return best ? std::optional<Bound>(*best) : std::nullopt;
    };
    std::optional<Bound> bounds[2];  // any, rigorous
    for (const int rigorous : {0, 1}) {
        const auto a = best_of(result, rigorous), b = best_of(finer, rigorous);
        bounds[rigorous] = !b || (a && a->K >= b->K) ? a : b;
    }
    if (!bounds[0]) return;
    std::vector<Bound> kept;
    if (bounds[0]) kept.push_back(*bounds[0]);
    if (bounds[1] && !bounds[0]->rigorous) kept.push_back(*bounds[1]);
    for (const Bound& bound : result.bounds)
        if (bound.kind != "reich_strebel" && bound.kind != "reich_strebel_estimate") kept.push_back(bound);
    if (finer.K_lower > result.K_lower) {  // else that mesh knows less, its estimate too
        result.K_lower = finer.K_lower;
        result.K = std::max(std::min(finer.K, result.K_max), result.K_lower);
        result.k = (result.K - 1) / (result.K + 1);
    }
    kept.push_back({"reich_strebel_estimate", result.K, Bound::Of::extremal, false});
    result.bounds = std::move(kept);
}

std::string percent(double gap) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * gap);
    return text;
}

/// Why no refinement can help, or nothing.
/// @param turns wanted, or empty
std::string obstacle(const ExtremalMap& map, const std::vector<int>& turns) {
    for (const HoleTurns& hole : map.homotopy.holes)
        if (!turns.empty() && hole.turns != turns[hole.loop])
            return "the map has " + std::to_string(hole.turns) + " turns against loop " + std::to_string(hole.loop) +
                   " instead of " + std::to_string(turns[hole.loop]) + ": what is known belongs to another class";
    if (map.termination == Termination::not_teichmuller)
        return "at vertex " + std::to_string(map.sharpest->vertex) + " the boundary values alone force K ≥ " +
               std::to_string(map.sharpest->safe_bound) +
               ": the extremal map is not of Teichmüller type and no differential attains its K";
    return {};
}

}  // namespace

void CertifyOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(most_triangles >= 1, "most_triangles must be at least 1");
    demand(most_refinements >= 0, "most_refinements must not be negative");
    demand(least_progress >= 0 && least_progress < 1, "least_progress must lie between 0 and 1");
}

Certification certify(const Surface& source, const Constraints& constraints, double gap, const ExtremalOptions& options,
                      const CertifyOptions& limits) {
    if (!(gap > 0)) throw Error(Cause::bad_option, "the gap must be positive");
    limits.validate();
    if (!constraints.all_prescribed())
        throw Error(Cause::bad_option, "where boundaries slide the bounds are estimates: nothing can be certified",
                    "prescribe the boundary values");
    ExtremalOptions own = options;
    own.sharpen = std::max(0, options.sharpen.value_or(0));
    Certification done;
    done.result = extremal_map(source, constraints, own);
    done.gap = gap_of(done.result);

    std::optional<RefinedProblem> level;
    Eigen::VectorXcd last = done.result.map.head(source.mesh.vertex_count());
    Constraints finer_constraints = constraints;
    finer_constraints.correspondence.waypoints.reset();  // the finer meshes start from the last map
    own.sharpen = 0;
    own.growth = std::min(options.growth, kGrowthOfGap * gap);
    while (true) {
        done.reason = obstacle(done.result, constraints.correspondence.turns);
        if (!done.reason.empty() && !(done.gap <= gap && done.result.termination == Termination::not_teichmuller))
            return done;
        if (done.gap <= gap) {
            done.reached = true;
            done.reason = "the gap is " + percent(done.gap);
            return done;
        }
        const Surface& surface = level ? level->surface : source;
        if (done.refinements >= limits.most_refinements) {
            done.reason = "the gap is " + percent(done.gap) + " after " + std::to_string(done.refinements) +
                          " refinements, which is the limit";
            return done;
        }
        if (surface.mesh.face_count() > limits.most_triangles / 4) {
            done.reason = "the gap is " + percent(done.gap) + "; the next mesh would have " +
                          std::to_string(4LL * surface.mesh.face_count()) + " faces, more than the limit of " +
                          std::to_string(limits.most_triangles);
            return done;
        }
        RefinedProblem next = refined_problem(surface, finer_constraints.prescribed);
        own.start = next.interpolated(last);
        level.emplace(std::move(next));
        finer_constraints.prescribed = level->boundary;
        const double before = done.gap;
        ExtremalMap finer;
        try {
            finer = extremal_map(level->surface, finer_constraints, own);
        } catch (const Error& error) {
            if (error.cause() == Cause::cancelled) throw;
            done.reason = "the gap is " + percent(before) + "; the finer mesh could not be solved: " + error.what();
            return done;
        }
        ++done.refinements;
        if (!done.result.homotopy.holes.empty() && !finer.homotopy.same_turns(done.result.homotopy)) {
            done.reason = "the gap is " + percent(before) + "; the map of the finer mesh is of another class";
            return done;
        }
        last = finer.map.head(level->surface.mesh.vertex_count());
        take_over(done.result, finer);
        done.gap = gap_of(done.result);
        if (done.gap <= gap) continue;
        if (!(done.gap < (1 - limits.least_progress) * before)) {
            done.reason = "the gap is " + percent(done.gap) + " and a refinement did not lower it noticeably";
            if (!finer.distortion.flipped.empty())
                done.reason +=
                    "; " + std::to_string(finer.distortion.flipped.size()) + " faces of the finer mesh are flipped";
            else if (!finer.sharpest || finer.sharpest->safe_bound < 0.9 * done.result.K)
                done.reason += "; the extremal map is not smooth enough for the differentials at hand";
            else
                done.reason += "; the corner at vertex " + std::to_string(finer.sharpest->vertex) + " forces K ≥ " +
                               std::to_string(finer.sharpest->safe_bound);
            return done;
        }
    }
}

}  // namespace beltrami
