#include <beltrami/teichmuller/certify.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/certificate/verified_bracket.h>
#include <beltrami/teichmuller/least_dilatation.h>
#include <beltrami/teichmuller/record_proofs.h>

namespace beltrami {

namespace {

/// The space may grow on a finer mesh while that raises k by more than this part of the wanted gap.
constexpr double kGrowthOfGap = 1e-3;

/// Infinite without a bound.
double gap_of(const ExtremalMap& map) {
    return map.K_lower > 1 || map.K == 1 ? map.K / map.K_lower - 1 : std::numeric_limits<double>::infinity();
}

/// The best bounds of all meshes, with the estimate of the mesh that has the largest.
void take_over(ExtremalMap& result, const ExtremalMap& finer) {
    const auto best_of = [](const ExtremalMap& map, bool rigorous) {
        const Bound* best = nullptr;
        for (const Bound& bound : map.bounds)
            if (bound.kind == Bound::Kind::reich_strebel && (bound.rigorous || !rigorous) &&
                (!best || bound.K > best->K))
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
        if (bound.kind != Bound::Kind::reich_strebel && bound.kind != Bound::Kind::reich_strebel_estimate)
            kept.push_back(bound);
    for (const Bound& other : finer.bounds) {  // proofs of the same problem on the finer mesh
        if (!other.rigorous || other.of != Bound::Of::extremal || other.kind == Bound::Kind::attained ||
            other.kind == Bound::Kind::reich_strebel)
            continue;
        const auto same = std::find_if(kept.begin(), kept.end(), [&](const Bound& b) { return b.kind == other.kind; });
        if (same == kept.end())
            kept.push_back(other);
        else if (other.K > same->K)
            *same = other;
    }
    result.K_lower_proved = std::max(result.K_lower_proved, finer.K_lower_proved);
    if (finer.K_lower > result.K_lower) {  // else that mesh knows less, its estimate too
        result.K_lower = finer.K_lower;
        result.K = std::max(std::min(finer.K, result.K_max), result.K_lower);
        result.k = k_of(result.K);
    }
    kept.push_back({Bound::Kind::reich_strebel_estimate, result.K, Bound::Of::extremal, false});
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

std::string rounded(double value, bool up) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5f", (up ? std::ceil(value * 1e5) : std::floor(value * 1e5)) / 1e5);
    return text;
}

/// Of exactly the given polygons also what single vertices prove counts.
void count_polygons(ExtremalMap& result) {
    for (Bound& bound : result.bounds)
        if (bound.of == Bound::Of::polygons) bound.of = Bound::Of::extremal;
    raise_to_proofs(result);
}

/// The surface in triangles, or nothing where its quads are bent.
std::optional<Surface> triangles_of(const Surface& source) {
    if (all_triangles(source.mesh)) return source;
    if (source.in_plane()) return cut_into_triangles(source);
    return std::nullopt;
}

/// Tries to prove what is wanted.
/// @return why not; empty: it is proved
std::string prove(const Surface& source, const BoundaryCondition& boundary, double gap, const CertifyOptions& limits,
                  Certification& done) {
    ExtremalMap& result = done.result;
    if (!boundary.lines.empty()) return "vertices are held to lines, for which no upper bound is verified";
    const Surface split = result.split ? surface_of(result.split->mesh, result.split->metric) : source;
    const std::optional<Surface> surface = triangles_of(split);
    if (!surface) return "quads in space have no one surface, so no upper bound is verified";
    if (surface->mesh.face_count() > limits.most_proof_triangles)
        return "the mesh has " + std::to_string(surface->mesh.face_count()) +
               " triangles, more than the limit of a proof, " + std::to_string(limits.most_proof_triangles);
    VerifiedBracketOptions options;
    options.gap = gap;
    options.K_lower = result.K_lower_proved;
    options.most_triangles = limits.most_proof_triangles;
    options.most_rounds = limits.most_refinements;
    options.least_progress = limits.least_progress;
    std::optional<VerifiedBracket> found;
    try {
        found.emplace(verified_bracket(*surface, boundary, result.map, options));
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved && error.cause() != Cause::bad_mesh) throw;
        return std::string("the verified map could not be found: ") + error.what();
    }
    const VerifiedBracket& bracket = *found;
    done.K_upper = bracket.K_upper;
    done.refinements = bracket.refinements;
    done.proof_triangles = bracket.surface.mesh.face_count();
    result.factorizations += bracket.factorizations;
    if (bracket.pair > 1) {
        std::erase_if(result.bounds,
                      [&](const Bound& bound) { return bound.kind == Bound::Kind::pair && bound.K < bracket.pair; });
        if (std::none_of(result.bounds.begin(), result.bounds.end(),
                         [](const Bound& b) { return b.kind == Bound::Kind::pair; }))
            result.bounds.push_back({Bound::Kind::pair, bracket.pair, Bound::Of::extremal, true});
        raise_to_proofs(result);
    }
    done.gap = done.K_upper / result.K_lower_proved - 1;
    return done.gap <= gap ? "" : bracket.reason;
}

}  // namespace

void CertifyOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(most_triangles >= 1, "most_triangles must be at least 1");
    demand(most_refinements >= 0, "most_refinements must not be negative");
    demand(most_proof_triangles >= 1, "most_proof_triangles must be at least 1");
    demand(least_progress >= 0 && least_progress < 1, "least_progress must lie between 0 and 1");
}

namespace {

/// Refines the whole problem while that improves the estimate.
/// @return why it ended; empty: the gap of the estimate is what is wanted
std::string improve_estimate(const Surface& source, const Constraints& constraints, double gap,
                             const ExtremalOptions& options, const CertifyOptions& limits, Certification& done) {
    ExtremalOptions own = options;
    std::optional<RefinedProblem> level;
    Eigen::VectorXcd last = done.result.map.head(source.mesh.vertex_count());
    Constraints finer_constraints = constraints;
    finer_constraints.correspondence.waypoints.reset();  // the finer meshes start from the last map
    own.sharpen = 0;
    own.growth = std::min(options.growth, kGrowthOfGap * gap);
    own.prove.reset();
    for (int refinements = 0;; ++refinements) {
        const double before = gap_of(done.result);
        if (std::string why = obstacle(done.result, constraints.correspondence.turns); !why.empty()) return why;
        if (before <= gap) return {};
        const Surface& surface = level ? level->surface : source;
        if (refinements >= limits.most_refinements)
            return "refined " + std::to_string(refinements) + " times, which is the limit";
        if (surface.mesh.face_count() > limits.most_triangles / 4)
            return "the next mesh would have " + std::to_string(4LL * surface.mesh.face_count()) +
                   " faces, more than the limit of " + std::to_string(limits.most_triangles);
        RefinedProblem next = refined_problem(surface, level ? level->boundary : constraints.prescribed);
        own.start = next.interpolated(last);
        level.emplace(std::move(next));
        ExtremalMap finer;
        try {
            finer_constraints.prescribed = level->boundary;
            finer = extremal_map(level->surface, finer_constraints, own);
        } catch (const Error& error) {
            if (error.cause() == Cause::cancelled) throw;
            return std::string("the finer mesh could not be solved: ") + error.what();
        }
        ++done.refinements;
        if (!done.result.homotopy.holes.empty() && !finer.homotopy.same_turns(done.result.homotopy))
            return "the map of the finer mesh is of another class";
        last = finer.map.head(level->surface.mesh.vertex_count());
        take_over(done.result, finer);
        const double now = gap_of(done.result);
        if (now <= gap || now < (1 - limits.least_progress) * before) continue;
        std::string why = "a refinement did not lower it noticeably";
        if (!finer.distortion.flipped.empty())
            why +=
                "; " +
                counted(finer.distortion.flipped.size(), "face of the finer mesh is", "faces of the finer mesh are") +
                " flipped";
        else if (!finer.sharpest || finer.sharpest->safe_bound < 0.9 * done.result.K)
            why += "; the extremal map is not smooth enough for the differentials at hand";
        else
            why += "; the corner at vertex " + std::to_string(finer.sharpest->vertex) + " forces K ≥ " +
                   std::to_string(finer.sharpest->safe_bound);
        return why;
    }
}

}  // namespace

Certification certify(const Surface& source, const Constraints& constraints, double gap, const ExtremalOptions& options,
                      const CertifyOptions& limits) {
    if (!(gap > 0)) throw Error(Cause::bad_option, "the gap must be positive");
    limits.validate();
    if (!constraints.all_prescribed())
        throw Error(Cause::bad_option, "where boundaries slide the bounds are estimates: nothing can be certified",
                    "prescribe the boundary values");
    if (const std::vector<int> free = free_parts(source, constraints.prescribed); !free.empty())
        throw Error(
            Cause::bad_boundary,
            std::to_string(free.size()) +
                " boundary vertices are free, and then no map attains the least K, which is 1: there is nothing "
                "to certify",
            "prescribe the whole boundary", {Things::vertices, free});
    ExtremalOptions own = options;
    own.sharpen = std::max(0, options.sharpen.value_or(0));
    if (!own.prove) own.prove = true;
    Certification done;
    done.result = extremal_map(source, constraints, own);
    count_polygons(done.result);
    const std::string unproved = prove(source, constraints.prescribed, gap, limits, done);
    done.reached = unproved.empty();
    std::string estimate;
    if (!done.reached) estimate = improve_estimate(source, constraints, gap, options, limits, done);
    ExtremalMap& result = done.result;
    if (result.K > done.K_upper) {  // an estimate that the bracket refutes, perhaps with the one below it
        result.K = done.K_upper;
        result.k = k_of(result.K);
        result.K_lower = std::min(result.K_lower, result.K);
    }
    done.gap = done.K_upper / result.K_lower_proved - 1;
    done.estimated_gap = gap_of(result);
    done.reached = done.gap <= gap;
    std::string known = "K* at least " + rounded(result.K_lower_proved, false);
    if (std::isfinite(done.K_upper)) {
        result.bounds.push_back({Bound::Kind::verified, done.K_upper, Bound::Of::extremal, true});
        known = "K* in [" + rounded(result.K_lower_proved, false) + ", " + rounded(done.K_upper, true) +
                "] (floating point), a gap of " + percent(done.gap);
    }
    if (done.reached) {
        done.reason = "proved: " + known;
    } else {
        done.reason = "not proved: known is " + known + ", since " + unproved;
        done.reason += "; the estimate is K = " + rounded(result.K, false) + ", " + percent(done.estimated_gap) +
                       " above its lower bound";
        if (!estimate.empty()) done.reason += " (" + estimate + ")";
    }
    return done;
}

}  // namespace beltrami
