#pragma once

#include <memory>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/targets/correspondence.h>
#include <beltrami/targets/target_mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A target domain with a circle domain that stands for it conformally: the unit disk less round holes, the same for
/// every shape of the class, in which a start is easily led to its place.
class TargetModel {
  public:
    virtual ~TargetModel() = default;

    const TargetDomain& domain() const { return domain_; }
    /// Holes of the model, beside those of the domain.
    const std::vector<RoundHole>& holes() const { return holes_; }
    /// The model's circle of a curve.
    RoundHole circle(int curve) const { return curve == 0 ? RoundHole{0, 0.0, 1.0} : holes_[curve - 1]; }
    int factorizations() const { return factorizations_; }

    /// Arc length on a curve of the place that the model has at an angle of the curve's circle.
    virtual double parameter(int curve, double angle) const = 0;
    /// The converse.
    virtual double angle(int curve, double parameter) const = 0;
    /// Places in the target of places in the model.
    virtual Eigen::VectorXcd places(const Eigen::VectorXcd& model) const = 0;
    /// The place in the model of a place in the target's plane, in holes as well where there is a natural one.
    virtual Complex model_place(Complex place) const = 0;

  protected:
    explicit TargetModel(TargetDomain domain) : domain_(std::move(domain)) {}

    TargetDomain domain_;
    std::vector<RoundHole> holes_;
    int factorizations_ = 0;
};

/// The model of a domain: itself, scaled, where all curves are circles; else the circle domain of a mesh of it.
/// @param edge_length of that mesh
/// @throw Error not_solved, bad_option
std::unique_ptr<TargetModel> target_model(const TargetDomain& target, double edge_length);

/// The edge length with which a mesh of the target has as many faces as the source, or @p wanted if that is not 0.
double edge_length_for(const Surface& source, const TargetDomain& target, double wanted = 0);

/// The circle domain of a chart as a target of its own.
TargetDomain circle_target(const CircleDomainChart& chart);

/// What a correspondence with a surface becomes where the circle domain of that surface stands for it: loops are paired
/// with its curves, marks go to places on them.
/// @throw Error bad_option for marks on curves or a loop that the target has not; bad_boundary for a vertex that is not
///        on its boundary
Correspondence correspondence_on_circles(const Correspondence& wanted, const Surface& target,
                                         const CircleDomainChart& chart);

}  // namespace beltrami
