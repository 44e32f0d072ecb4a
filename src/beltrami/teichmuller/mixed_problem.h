#pragma once

#include <beltrami/teichmuller/mixed_start.h>
#include <beltrami/teichmuller/sliding_problem.h>

namespace beltrami {

/// The admissible differentials of a mixed problem.
/// @param start of which the derivative says where vertices may move that are held to lines
/// @param most  the largest degree that φ may have where arcs are prescribed, if the mesh resolves it; none: all that
///              it resolves
/// @throw Error not_solved
AdmissibleDifferentials mixed_differentials(const Surface& source, const CircleDomainChart& domain,
                                            const MixedBoundary& boundary, const Eigen::VectorXcd& start,
                                            std::optional<int> most = {});

/// Examines a mixed problem and splits the edges that it would nail down.
/// @throw Error bad_mesh, bad_boundary, bad_option
PreparedProblem prepare_mixed(const Surface& source, const MixedConditions& conditions, const ExtremalOptions& options);

/// Something is prescribed and something slides.
class MixedProblem final : public SlidingProblem {
  public:
    /// @param source kept by reference
    /// @param marks  how many vertices, the last ones that are prescribed, keep their images for good
    /// @param most   see mixed_differentials
    /// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
    MixedProblem(const Surface& source, MixedConditions conditions, const ExtremalOptions& options,
                 std::size_t marks = 0, std::optional<int> most = {});

    /// Whether anything but single vertices is prescribed of the boundary, so that Q has no finite dimension.
    bool prescribes_arcs() const;

    SlidingStart start() const override;
    bool has_given_start() const override { return given_start_.has_value(); }
    void forget_given_start() override { given_start_.reset(); }
    AdmissibleDifferentials differentials(const Eigen::VectorXcd& start, BeltramiSolver& solver) const override;
    const BoundaryCondition& prescribed() const override { return boundary_.prescribed; }
    BoundaryCondition marked() const override { return {}; }
    std::vector<SlidingLoop> move(const std::vector<Complex>& images) override;

  private:
    std::vector<SlidingLoop> feasible_places(const MixedBoundary& boundary) const;

    MixedConditions conditions_;
    std::size_t marks_;
    std::optional<int> most_;
    MixedBoundary boundary_;
    std::optional<Eigen::VectorXcd> given_start_;  ///< of source()
};

}  // namespace beltrami
