#include <beltrami/teichmuller/record_proofs.h>

#include <algorithm>
#include <limits>

#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/certificate/refined_pair.h>
#include <beltrami/certificate/refined_problem.h>

namespace beltrami {

namespace {

/// Estimates of K that are below a proved bound by no more than this part are as good as the mesh lets them be.
constexpr double kErrorOfEstimate = 0.01;
/// Where the bracket is no wider than this part of K no mesh is refined.
constexpr double kNarrow = 0.002;

/// The bound by pairs, where K is a larger one.
void raise_pair(double K, ExtremalMap& result) {
    if (!(K > 1)) return;
    const auto coarser = std::find_if(result.bounds.begin(), result.bounds.end(),
                                      [](const Bound& bound) { return bound.kind == Bound::Kind::pair; });
    if (coarser == result.bounds.end())
        result.bounds.push_back({Bound::Kind::pair, K, Bound::Of::extremal, true});
    else
        coarser->K = std::max(coarser->K, K);
}

}  // namespace

double largest_proof(const std::vector<Bound>& bounds) {
    double K = 1;
    for (const Bound& bound : bounds)
        if (bound.proves_from_below()) K = std::max(K, bound.K);
    return K;
}

namespace {

/// What is proved, or forced by quadrilaterals in the chart: an estimate, but no less a sign that φ does not show the
/// map.
double forced(const std::vector<Bound>& bounds) {
    double K = largest_proof(bounds);
    for (const Bound& bound : bounds)
        if (bound.kind == Bound::Kind::moduli) K = std::max(K, bound.K);
    return K;
}

}  // namespace

double largest_known(const ExtremalMap& result) {
    return std::max(result.K_lower, forced(result.bounds));
}

bool clearly_below(double K, double known) {
    return K < (1 - kErrorOfEstimate) * known;
}

void raise_to_proofs(ExtremalMap& result) {
    result.K_lower_proved = largest_proof(result.bounds);
    const double least = forced(result.bounds);
    result.K_lower = std::max(result.K_lower, least);
    if (!(result.K < least)) return;
    double found = result.K;
    for (const Bound& bound : result.bounds)  // K itself may have been raised before
        if (bound.kind == Bound::Kind::reich_strebel_estimate) found = std::min(found, bound.K);
    result.K = least;
    result.k = k_of(result.K);
    // What the map attains is then as good as what is proved, whatever φ shows.
    const bool attained = std::any_of(result.bounds.begin(), result.bounds.end(), [&](const Bound& bound) {
        return bound.kind == Bound::Kind::attained && bound.rigorous &&
               bound.K <= (1 + kErrorOfEstimate) * result.K_lower_proved;
    });
    if (attained || !clearly_below(found, result.K)) return;
    if (result.termination == Termination::converged) result.termination = Termination::below_bound;
    result.noise.reset();  // an estimate by the same differentials
    std::erase_if(result.warnings, [](const Warning& warning) { return warning.kind == WarningKind::below_bound; });
    const std::string needed = least > result.K_lower_proved ? ", but quadrilaterals of the outline force about "
                                                             : ", but no map with these conditions has less than ";
    result.warnings.push_back(
        {WarningKind::below_bound, "the iteration ended with K = " + std::to_string(found) + needed +
                                       std::to_string(result.K) +
                                       ": the differentials at hand do not show the extremal map; a finer mesh would"});
}

void add_proofs(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options,
                ExtremalMap& result) {
    ProvedBoundsOptions how;
    const bool never = options.sharpen.value_or(0) < 0;
    if (options.prove || never)
        how.most_faces_for_pairs = options.prove.value_or(false) ? std::numeric_limits<int>::max() : 0;
    const ProvedBounds proved = proved_bounds(source, boundary, result.map, how);
    result.factorizations += proved.factorizations;
    result.bounds.insert(result.bounds.end(), proved.bounds.begin(), proved.bounds.end());
}

void add_finer_pair(const Surface& source, const BoundaryCondition& boundary, double known, ExtremalMap& result) {
    RefinedPairOptions how;
    // Where K is no more than what is proved, φ does not show how much more there is.
    if (result.K > known) how.enough = result.K / (1 + kNarrow);
    const bool refines = all_triangles(source.mesh) && source.mesh.face_count() <= how.most_faces;
    if (!refines || !(known < how.enough)) return;
    const RefinedPair pair = refined_pair_bound(source, boundary, result.map, how);
    result.factorizations += pair.factorizations;
    raise_pair(pair.K, result);
}

}  // namespace beltrami
