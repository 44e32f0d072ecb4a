#include <beltrami/teichmuller/sliding_problem.h>

#include <beltrami/charts/shape.h>

namespace beltrami {

namespace {

/// A hole whose centre is nearer to that of the disk says nothing about directions.
constexpr double kOffCentre = 1e-3;

}  // namespace

SlidingProblem::SlidingProblem(const Surface& given, PreparedProblem prepared, int outer_loop, const char* kind,
                               std::vector<const Shape*> shapes)
    : given_(given),
      prepared_(std::move(prepared)),
      source_(prepared_.surface_of(given)),
      outer_loop_(outer_loop),
      kind_(kind),
      shapes_(std::move(shapes)) {}

const CircleDomainChart& SlidingProblem::domain() const {
    if (!domain_) {
        const Shape* kept = shape();
        domain_ = kept ? kept->circles(outer_loop_) : circle_domain_chart(source_, outer_loop_);
    }
    return *domain_;
}

const Shape* SlidingProblem::shape() const {
    const Shape* given = shape_of(given_, shapes_);
    return given ? &given->without_bridges() : nullptr;
}

double SlidingProblem::phase() const {
    for (const RoundHole& hole : domain().holes)
        if (std::abs(hole.centre) > kOffCentre) return std::arg(hole.centre);
    return std::arg(domain().chart.vertices[source_.topology.boundary_loops[outer_loop()][0]]);
}

Warnings SlidingProblem::warnings() const {
    Warnings result;
    if (prepared_.split) result.push_back(prepared_.split_warning(kind_));
    if (domain_) append(result, domain_->chart.warnings);
    return result;
}

}  // namespace beltrami
