#pragma once

#include <optional>
#include <vector>

#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/teichmuller/extremal_options.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/problem_chart.h>

namespace beltrami {

/// In which chart φ of a prescribed problem is written down, where it may be singular there, and whether it is let: at
/// corners that only a fine mesh would resolve poles are withheld until the bracket asks for them.
class PoleChoice {
  public:
    /// All are kept by reference; corners are those of the boundary values as they are at choose().
    PoleChoice(ExtremalProblem& problem, const BoundaryCondition& boundary, const std::vector<BoundaryCorner>& corners,
               const ExtremalOptions& options);

    /// Gives the problem its chart and singularities.
    /// @param plain the iteration is to begin from the harmonic map, in its class
    /// @return where it may begin, if the problem on a coarse mesh has shown that poles need not be
    HamiltonState choose(ProblemChart charts, bool plain);
    /// Lets φ have the singularities that were withheld, at a map.
    void take_withheld(const Eigen::VectorXcd& map);
    /// Lets poles follow the map at vertices held to lines one by one; whether any had turned.
    bool follow(const Eigen::VectorXcd& map);

    bool withheld() const { return withheld_.has_value(); }
    /// Whether they were although the coarse problem sees them: bends narrower than an edge.
    bool narrow_bends() const { return withheld() && widest_bracket_ < kPolesNeeded; }
    /// Whether singularities that were withheld are needed after all, for all that a bracket of K shows (as part of K).
    bool needed(double bracket) const { return withheld() && bracket > widest_bracket_; }
    double widest_bracket() const { return widest_bracket_; }  ///< with which φ may do without them
    bool smooth() const { return smooth_; }                    ///< φ has no singularities
    bool elongated() const { return elongated_; }              ///< see elongation.h
    /// Noise of the chart of a disk in space, as part of k; 0 where it was not asked for (chart_metric.h).
    double noise() const { return noise_; }
    /// The space of φ where the boundary values crowd (crowding.h); null elsewhere.
    const std::optional<TabulatedSpace>& products() const { return products_; }

    /// Width of the bracket, as part of K, from which on poles are needed in any case.
    static constexpr double kPolesNeeded = 0.01;

  private:
    std::ptrdiff_t image_corners() const;
    std::vector<BoundaryCorner> clear_corners() const;
    bool wants_chart_metric();
    void take_form_products();
    Singularities take_chart(Chart chart, const Eigen::VectorXcd& at);
    Singularities take_instead(const Eigen::VectorXcd& at);

    ExtremalProblem& problem_;
    const BoundaryCondition& boundary_;
    const std::vector<BoundaryCorner>& corners_;
    const ExtremalOptions& options_;
    HeldVertices held_alone_;       // as the space of differentials has them
    std::optional<Chart> instead_;  // for φ that has singularities
    std::optional<Singularities> withheld_;
    double widest_bracket_ = kPolesNeeded;  // with which φ may do without them
    double noise_ = 0;
    bool smooth_ = true, elongated_ = false, round_image_ = false;
    std::optional<TabulatedSpace> products_;
};

}  // namespace beltrami
