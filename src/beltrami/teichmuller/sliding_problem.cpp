#include <beltrami/teichmuller/sliding_problem.h>

namespace beltrami {

namespace {

/// A hole whose centre is nearer to that of the disk says nothing about directions.
constexpr double kOffCentre = 1e-3;

}  // namespace

SlidingProblem::SlidingProblem(const Surface& given, PreparedProblem prepared, int outer_loop, const char* kind)
    : prepared_(std::move(prepared)),
      source_(prepared_.surface_of(given)),
      domain_(circle_domain_chart(source_, outer_loop)),
      kind_(kind) {}

double SlidingProblem::phase() const {
    for (const RoundHole& hole : domain_.holes)
        if (std::abs(hole.centre) > kOffCentre) return std::arg(hole.centre);
    return std::arg(domain_.chart.vertices[source_.topology.boundary_loops[outer_loop()][0]]);
}

std::vector<std::string> SlidingProblem::warnings() const {
    std::vector<std::string> result;
    if (prepared_.split) result.push_back(prepared_.split_warning(kind_));
    result.insert(result.end(), domain_.chart.warnings.begin(), domain_.chart.warnings.end());
    return result;
}

}  // namespace beltrami
