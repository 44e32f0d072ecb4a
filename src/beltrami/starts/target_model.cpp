#include <beltrami/starts/target_model.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/boundary_position.h>

namespace beltrami {

namespace {

/// A target whose curves are circles: its model is itself, the outer circle scaled to the unit circle.
class RoundTarget final : public TargetModel {
  public:
    explicit RoundTarget(const TargetDomain& target)
        : TargetModel(target), centre_(target.outer.centre()), radius_(target.outer.radius()) {
        for (const TargetCurve& hole : target.holes)
            holes_.push_back(
                {static_cast<int>(holes_.size()) + 1, (hole.centre() - centre_) / radius_, hole.radius() / radius_});
    }
    double parameter(int curve, double angle) const override {
        const TargetCurve& c = domain_.curve(curve);
        return c.wrap(c.counter_clockwise() ? c.radius() * angle : -c.radius() * angle);
    }
    double angle(int curve, double parameter) const override {
        const TargetCurve& c = domain_.curve(curve);
        return c.counter_clockwise() ? parameter / c.radius() : -parameter / c.radius();
    }
    Eigen::VectorXcd places(const Eigen::VectorXcd& model) const override {
        return (radius_ * model.array() + centre_).matrix();
    }
    Complex model_place(Complex place) const override { return (place - centre_) / radius_; }

  private:
    Complex centre_;
    double radius_;
};

/// Any other target: a mesh of it and its circle domain.
class MeshedTarget final : public TargetModel {
  public:
    MeshedTarget(const TargetDomain& target, double edge_length)
        : TargetModel(target),
          mesh_(target_mesh(target, {.edge_length = edge_length})),
          surface_(mesh_.mesh),
          chart_(circle_domain_chart(surface_)) {
        holes_.resize(target.holes.size());
        loop_of_curve_.resize(domain_.curve_count());
        for (std::size_t l = 0; l < mesh_.curve_of_loop.size(); ++l)
            loop_of_curve_[mesh_.curve_of_loop[l]] = static_cast<int>(l);
        for (int c = 1; c < domain_.curve_count(); ++c) {
            holes_[c - 1] = chart_.circle(loop_of_curve_[c]);
            holes_[c - 1].loop = c;
        }
        factorizations_ = chart_.factorizations;
    }
    double parameter(int curve, double angle) const override {
        const int loop = loop_of_curve_[curve];
        const BoundaryPlace place = boundary_place(surface_, chart_, loop, angle);
        const auto& vertices = surface_.topology.boundary_loops[loop];
        const double from = mesh_.parameter[vertices[place.edge]],
                     to = mesh_.parameter[vertices[(place.edge + 1) % vertices.size()]];
        return domain_.curve(curve).wrap(from + place.fraction * domain_.curve(curve).ahead(from, to));
    }
    double angle(int curve, double parameter) const override {
        const int loop = loop_of_curve_[curve];
        const auto& vertices = surface_.topology.boundary_loops[loop];
        const Complex centre = chart_.circle(loop).centre;
        // The edge whose start is least far behind.
        std::size_t edge = 0;
        double least = domain_.curve(curve).length();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double behind = domain_.curve(curve).ahead(mesh_.parameter[vertices[i]], parameter);
            if (behind < least) least = behind, edge = i;
        }
        const int a = vertices[edge], b = vertices[(edge + 1) % vertices.size()];
        const double whole = domain_.curve(curve).ahead(mesh_.parameter[a], mesh_.parameter[b]);
        const Complex from = chart_.chart.vertices[a] - centre, to = chart_.chart.vertices[b] - centre;
        return std::arg(from) + (whole > 0 ? least / whole : 0) * std::arg(to / from);
    }
    Eigen::VectorXcd places(const Eigen::VectorXcd& model) const override {
        const std::vector<Complex> points(model.begin(), model.end());
        const std::vector<MeshPoint> found = locate_in_chart(surface_, chart_.chart.vertices, points);
        const Eigen::VectorXcd& plane = *surface_.coordinate();
        Eigen::VectorXcd result(model.size());
        for (Eigen::Index i = 0; i < model.size(); ++i) result[i] = found[i].interpolate(plane);
        return result;
    }
    Complex model_place(Complex place) const override { return place; }

  private:
    TargetMesh mesh_;
    Surface surface_;
    CircleDomainChart chart_;
    std::vector<int> loop_of_curve_;
};

}  // namespace

std::unique_ptr<TargetModel> target_model(const TargetDomain& target, double edge_length) {
    bool round = target.outer.kind() == TargetCurve::Kind::circle;
    for (const TargetCurve& hole : target.holes) round = round && hole.kind() == TargetCurve::Kind::circle;
    if (round) return std::make_unique<RoundTarget>(target);
    return std::make_unique<MeshedTarget>(target, edge_length);
}

double edge_length_for(const Surface& source, const TargetDomain& target, double wanted) {
    return wanted > 0 ? wanted : std::sqrt(4 / std::sqrt(3.0) * target.area() / source.mesh.face_count());
}

TargetDomain circle_target(const CircleDomainChart& chart) {
    TargetDomain target{TargetCurve::circle(0, 1), {}};
    for (const RoundHole& hole : chart.holes)
        target.holes.push_back(TargetCurve::circle(hole.centre, hole.radius).reversed());
    return target;
}

namespace {

/// Curves of a circle domain: 0 for the outer loop, then the holes of the chart.
int curve_of_loop(const CircleDomainChart& chart, int loop) {
    if (loop == chart.outer_loop()) return 0;
    for (std::size_t h = 0; h < chart.holes.size(); ++h)
        if (chart.holes[h].loop == loop) return static_cast<int>(h) + 1;
    throw Error(Cause::bad_option, "the target has no boundary loop " + std::to_string(loop),
                "loops are counted from 0", {Things::loops, {loop}});
}

/// The place on the circle domain of a boundary vertex of the target.
CurveParameter place_on_circles(const Surface& target, const CircleDomainChart& chart, int vertex) {
    const std::optional<BoundaryPosition> on = boundary_position(target.topology, vertex);
    if (!on)
        throw Error(Cause::bad_boundary,
                    "the mark's vertex " + std::to_string(vertex) + " is not on the boundary of the target",
                    "mark boundary vertices only", {Things::vertices, {vertex}});
    const RoundHole circle = chart.circle(on->loop);
    const int curve = curve_of_loop(chart, on->loop);
    const double angle = std::arg(chart.chart.vertices[vertex] - circle.centre);
    return {curve, circle.radius * (curve == 0 ? angle : -angle)};
}

}  // namespace

Correspondence correspondence_on_circles(const Correspondence& wanted, const Surface& target,
                                         const CircleDomainChart& chart) {
    Correspondence result = wanted;
    for (auto& [loop, curve] : result.loops) curve = curve_of_loop(chart, curve);
    for (Mark& mark : result.marks) {
        const TargetVertex* to = std::get_if<TargetVertex>(&mark.to);
        if (!to)
            throw Error(Cause::bad_option, "marks on curves are given for a target that is a surface",
                        "give pairs of vertices instead", {Things::vertices, {mark.vertex}});
        mark.to = place_on_circles(target, chart, to->vertex);
    }
    return result;
}

}  // namespace beltrami
