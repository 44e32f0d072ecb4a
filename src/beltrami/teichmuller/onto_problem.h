#pragma once

#include <beltrami/certificate/modulus.h>
#include <beltrami/teichmuller/sliding_problem.h>

namespace beltrami {

/// Every boundary loop slides along its curve of a target, or to its loop of a surface; marks are held.
class OntoProblem final : public SlidingProblem {
  public:
    /// @param source kept by reference
    /// @param target the model of the constraints' target, kept by reference; null: made here
    /// @pre constraints.all_slides()
    /// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
    OntoProblem(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                const TargetModel* target = nullptr);

    int factorizations() const override;
    std::optional<ExtremalMap> direct() const override;
    std::optional<ExtremalMap> instead() const override;
    SlidingStart start() const override;
    bool has_given_start() const override { return options_.start.has_value(); }
    void forget_given_start() override { options_.start.reset(); }
    AdmissibleDifferentials differentials(const Eigen::VectorXcd& start, BeltramiSolver& solver) const override;
    const BoundaryCondition& prescribed() const override { return nothing_; }
    BoundaryCondition marked() const override;
    std::vector<SlidingLoop> move(const std::vector<Complex>& images) override;
    void record(ExtremalMap& result) const override;
    void prove(ExtremalMap& result) const override;

  private:
    SlidingStart straight_start() const;
    std::optional<ModulusBracket> ring_modulus_of_target() const;
    void make_target(const Surface& source, const Constraints& constraints, const TargetModel* given);

    ExtremalOptions options_;
    const Surface* target_surface_ = nullptr;          // where the target is one
    std::optional<CircleDomainChart> target_circles_;  // of it
    Correspondence wanted_;                            // with curves
    std::unique_ptr<TargetModel> own_target_;
    const TargetModel* target_ = nullptr;
    std::vector<int> marked_;  // vertices in the order of the loops
    BoundaryCondition nothing_;
};

}  // namespace beltrami
