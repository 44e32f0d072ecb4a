#include <beltrami/teichmuller/admissible_differentials.h>

#include <algorithm>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/shape.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/one_form_squares.h>
#include <beltrami/differentials/projected_space.h>

namespace beltrami {

namespace {

/// #V tangents of the circles of a circle domain.
Eigen::VectorXcd circle_tangents(const Surface& source, const CircleDomainChart& domain) {
    Eigen::VectorXcd result = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (const int v : loops[l])
            result[v] = Complex(0, 1) * (domain.chart.vertices[v] - domain.circle(static_cast<int>(l)).centre);
    return result;
}

/// On round disks and annuli Laurent series are exact and best: k of the disk with four marks is off by 5e-5 at 13 824
/// triangles, by 2e-4 with the other two; of the ring .5 → .3 at h = .02 by 5e-6 against 3e-5. From two holes on the
/// errors of projections cancel those of the map better. Corners ask for squares of 1-forms.
ExtremalOptions::Space automatic_kind(const CircleDomainChart& domain, bool quadrilateral) {
    using Space = ExtremalOptions::Space;
    if (domain.chart.exact && domain.holes.size() <= 1) return Space::laurent;
    return quadrilateral ? Space::one_form_squares : Space::projection;
}

/// Under which a shape keeps its projected differentials.
std::string name_of_projection(int outer_loop, const std::vector<int>& marked) {
    std::string name = "differentials by projection, outer loop " + std::to_string(outer_loop);
    for (const int v : marked) name += ", " + std::to_string(v);
    return name;
}

}  // namespace

AdmissibleDifferentials admissible_differentials(const Surface& source, const CircleDomainChart& domain,
                                                 ExtremalOptions::Space wanted, const std::vector<int>& marked,
                                                 int dimension, BeltramiSolver* solver, const Shape* shape) {
    using Space = ExtremalOptions::Space;
    AdmissibleDifferentials result;
    result.kind = wanted;
    const bool quadrilateral = domain.holes.empty() && marked.size() == 4;
    if (result.kind == Space::automatic) result.kind = automatic_kind(domain, quadrilateral);
    if (dimension == 0) return result;
    if (result.kind == Space::one_form_squares) {
        if (!quadrilateral)
            throw Error(Cause::bad_option, "squares of 1-forms are for disks with four marks",
                        "leave the space to be chosen automatically");
        result.chart = chart_of_frames(source);
        result.space = std::make_unique<TabulatedSpace>(
            std::move(quadrilateral_space(source, {marked[0], marked[1], marked[2], marked[3]}).space));
        result.gap = std::numeric_limits<double>::infinity();
        return result;
    }
    result.chart = domain.chart;
    if (result.kind == Space::projection) {
        ProjectionOptions how;
        how.marked = marked;
        how.tangents = circle_tangents(source, domain);
        // What is kept must not depend on whose solver it was.
        if (!shape) how.solver = solver;
        const auto project = [&] { return projected_space(source, domain.chart, how); };
        ProjectedSpace projected =
            shape ? shape->once<ProjectedSpace>(name_of_projection(domain.outer_loop(), marked), project) : project();
        result.gap = projected.gap;
        result.warnings = std::move(projected.warnings);
        result.space = std::make_unique<TabulatedSpace>(std::move(projected.space));
        return result;
    }
    const std::optional<RoundDomain> round = round_domain(source, domain.chart, marked);
    if (!round) throw Error(Cause::not_solved, "the chart of the source is not a circle domain");
    auto laurent = std::make_unique<LaurentSpace>(*round);
    result.gap = laurent->fit().next / std::max(laurent->fit().residual, 1e-16);
    result.space = std::move(laurent);
    return result;
}

}  // namespace beltrami
