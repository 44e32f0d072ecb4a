#include <beltrami/teichmuller/onto_problem.h>

#include <algorithm>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/charts/shape.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/starts/given_start.h>
#include <beltrami/targets/target_mesh.h>
#include <beltrami/teichmuller/coarse_sliding_start.h>
#include <beltrami/teichmuller/direct_map.h>
#include <beltrami/teichmuller/hyperbolic_sliding_start.h>
#include <beltrami/teichmuller/onto_annulus.h>
#include <beltrami/teichmuller/onto_quadrilateral.h>

namespace beltrami {

namespace {

PreparedProblem prepare_onto(const Surface& source, const Constraints& constraints, const ExtremalOptions& options) {
    options.validate();
    require_genus_zero(source);
    validate(constraints, source);
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (!options.start_turns.empty() && static_cast<int>(options.start_turns.size()) != loops)
        throw Error(Cause::bad_option, "start turns are given for " + std::to_string(options.start_turns.size()) +
                                           " boundary loops, the source has " + std::to_string(loops));
    if (options.start && constraints.correspondence.waypoints)
        throw Error(Cause::bad_option, "waypoints fix the homotopy class: give no start with them");
    if (options.start && options.start->size() != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(options.start->size()) + " values for " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    const Shape* shape = shape_of(source, options.shapes);
    if (!shape) return prepared(split_bridges(source));
    shape->without_bridges();
    return shape->bridges() ? prepared(*shape->bridges()) : PreparedProblem();
}

/// Marked vertices in the order of the loops.
std::vector<int> marked_vertices(const Surface& source, const std::vector<Mark>& marks) {
    std::vector<int> result;
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop)
            if (std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.vertex == v; }))
                result.push_back(v);
    return result;
}

}  // namespace

OntoProblem::OntoProblem(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                         const TargetModel* target)
    : SlidingProblem(source, prepare_onto(source, constraints, options), constraints.correspondence.outer_loop,
                     "boundary", options.shapes),
      options_(options),
      wanted_(constraints.correspondence) {
    make_target(source, constraints, target);
    marked_ = marked_vertices(this->source(), wanted_.marks);
}

void OntoProblem::make_target(const Surface& source, const Constraints& constraints, const TargetModel* given) {
    if (const SurfaceTarget* onto = constraints.surface()) {
        target_surface_ = onto->surface;
        target_circles_ = circle_domain_of(*onto->surface, onto->outer_loop, options_.shapes);
        wanted_ = correspondence_on_circles(wanted_, *onto->surface, *target_circles_);
    }
    if (!given) {
        own_target_ = target_surface_
                          ? target_model(circle_target(*target_circles_), 0)
                          : target_model(*constraints.domain(),
                                         edge_length_for(source, *constraints.domain(), options_.target_edge_length));
    }
    target_ = given ? given : own_target_.get();
}

int OntoProblem::factorizations() const {
    return SlidingProblem::factorizations() + target_->factorizations() +
           (target_circles_ ? target_circles_->factorizations : 0);
}

std::optional<ExtremalMap> OntoProblem::direct() const {
    if (options_.start) return {};
    if (target_surface_) return instead();
    if (auto ring = crowded_annulus_onto_ring(source(), *target_, wanted_)) return ring;
    return quadrilateral_onto_rectangle(source(), *target_, wanted_);
}

std::optional<ExtremalMap> OntoProblem::instead() const {
    if (source().topology.boundary_loops.size() != 2) return {};
    if (!target_surface_) return annulus_onto_ring(source(), *target_, wanted_);
    const ModulusBracket modulus = ring_modulus(*target_surface_);
    std::optional<ExtremalMap> result = annulus_onto_ring(source(), *target_, wanted_, &modulus);
    if (!result || (all_triangles(source().mesh) && all_triangles(target_surface_->mesh))) return result;
    for (Bound& bound : result->bounds) bound.rigorous = false;  // quads in space have no one surface
    result->K_lower_proved = 1;
    return result;
}

/// Without a start that is given or found on a coarse mesh.
SlidingStart OntoProblem::straight_start() const {
    if (wanted_.marks.empty() && !wanted_.waypoints && source().topology.boundary_loops.size() > 2) {
        SlidingStart even = even_start(source(), domain(), *target_, wanted_, options_.start_turns);
        if (even.flips == 0) return even;
        if (auto found =
                hyperbolic_sliding_start(source(), *target_, even, edge_length_for(source(), target_->domain())))
            return std::move(*found);
    }
    return sliding_start(source(), domain(), *target_, wanted_, options_.start_turns);
}

SlidingStart OntoProblem::start() const {
    std::optional<SlidingStart> result;
    if (options_.start)
        result =
            given_start(source(), target_->domain(),
                        split() ? with_parents_means(*options_.start, split()->parents) : *options_.start, wanted_);
    if (!result) result = coarse_sliding_start(source(), domain(), *target_, wanted_, options_);
    if (!result) result = straight_start();
    hold_what_conformal_maps_move(result->loops, outer_loop(), marked_.size());
    return std::move(*result);
}

AdmissibleDifferentials OntoProblem::differentials(const Eigen::VectorXcd&, BeltramiSolver& solver) const {
    const int dimension =
        dimension_of_differentials(static_cast<int>(domain().holes.size()), static_cast<int>(marked_.size()));
    AdmissibleDifferentials result =
        admissible_differentials(source(), domain(), options_.space, marked_, dimension, &solver, shape());
    result.expected_dimension = dimension;
    result.poles = marked_;
    std::sort(result.poles.begin(), result.poles.end());
    return result;
}

BoundaryCondition OntoProblem::marked() const {
    BoundaryCondition result;
    for (const Mark& mark : wanted_.marks) {
        const CurveParameter& place = on_curve(mark);
        result.pin(mark.vertex, target_->domain().curve(place.curve).point(place.parameter));
    }
    return result;
}

std::vector<SlidingLoop> OntoProblem::move(const std::vector<Complex>& images) {
    if (!images.empty())
        throw Error(Cause::bad_boundary,
                    "there are " + std::to_string(images.size()) + " new images, but nothing is prescribed");
    return {};
}

/// The dilatation of the extremal map is the ratio of the moduli where there is but one: of rings without marks and of
/// disks with four.
void OntoProblem::prove(ExtremalMap& result) const {
    // Of a domain two factorisations are little; of surfaces, which are compared in pairs, they would be much.
    const bool proves = options_.prove.value_or(!target_surface_ || source().mesh.face_count() <=
                                                                        ProvedBoundsOptions().most_faces_for_pairs);
    if (!proves || !all_triangles(source().mesh)) return;
    const auto record = [&](const ModulusBracket& own, const ModulusBracket& other) {
        result.factorizations += own.factorizations + other.factorizations;
        record_moduli(modulus_ratio(own, other), std::max(other.upper / own.lower, own.upper / other.lower), result);
    };
    if (source().topology.boundary_loops.size() == 2 && wanted_.marks.empty()) {
        if (const auto other = ring_modulus_of_target()) record(ring_modulus(source()), *other);
    } else if (const auto marked = marked_quadrilateral(source(), wanted_); marked && !target_surface_) {
        if (const auto other = target_modulus(target_->domain(), marked->parameters))
            record(quadrilateral_modulus(source().operators,
                                         sides_between(source().topology.boundary_loops[0], marked->positions)),
                   {*other, *other});
    }
}

std::optional<ModulusBracket> OntoProblem::ring_modulus_of_target() const {
    if (target_surface_) {
        if (!all_triangles(target_surface_->mesh)) return {};
        return ring_modulus(*target_surface_);
    }
    const TargetDomain& domain = target_->domain();
    const auto are = [&](TargetCurve::Kind kind) {
        return domain.outer.kind() == kind && domain.holes[0].kind() == kind;
    };
    if (are(TargetCurve::Kind::circle)) {
        const double modulus = round_ring_modulus(domain.outer.centre(), domain.outer.radius(),
                                                  domain.holes[0].centre(), domain.holes[0].radius());
        return ModulusBracket{modulus, modulus};
    }
    if (!are(TargetCurve::Kind::polygon)) return {};
    return ring_modulus(Surface(target_mesh(domain, {.edge_length = edge_length_for(source(), domain)}).mesh));
}

/// From the target's circle domain back to its faces.
void OntoProblem::record(ExtremalMap& result) const {
    if (!target_surface_ || !options_.places) return;
    const std::vector<Complex> images(result.map.begin(), result.map.end());
    result.places = locate_in_chart(*target_surface_, target_circles_->chart.vertices, images);
    result.positions = positions_on(target_surface_->mesh, result.places);
    result.target_circles = target_circles_;
}

}  // namespace beltrami
