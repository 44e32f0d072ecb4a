#pragma once

#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/starts/sliding_start.h>
#include <beltrami/teichmuller/admissible_differentials.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/prepared_problem.h>

namespace beltrami {

/// A problem some or all of whose boundary slides: the mesh, where the iteration begins and with which differentials.
/// How it is solved (sliding_solver.h) is the same for all.
class SlidingProblem {
  public:
    SlidingProblem(const SlidingProblem&) = delete;
    virtual ~SlidingProblem() = default;

    /// The mesh to solve on: no edge across it joins two boundary vertices.
    const Surface& source() const { return source_; }
    const std::optional<SplitProblem>& split() const { return prepared_.split; }
    /// The circle domain of source(), made when it is first asked for.
    /// @throw Error bad_mesh, not_solved
    const CircleDomainChart& domain() const;
    /// Rotation of the c-step's grid, tied to the source's shape.
    double phase() const;
    /// What the result says about split and chart.
    Warnings warnings() const;
    /// Of the charts.
    virtual int factorizations() const { return domain_ ? domain_->factorizations : 0; }

    /// The extremal map where it is known without an iteration.
    virtual std::optional<ExtremalMap> direct() const { return {}; }
    /// Another map that is as good as extremal, where the iteration has no start.
    virtual std::optional<ExtremalMap> instead() const { return {}; }
    /// Where to begin. What conformal maps of the source to itself would move is held.
    /// @throw Error bad_boundary, not_solved
    virtual SlidingStart start() const = 0;
    /// Whether the start is one that was given; start() makes another one after that was forgotten.
    virtual bool has_given_start() const { return false; }
    virtual void forget_given_start() {}
    /// @param start  of which the derivative says where vertices may move that are held to lines
    /// @param solver of the f-step, which may be used
    virtual AdmissibleDifferentials differentials(const Eigen::VectorXcd& start, BeltramiSolver& solver) const = 0;

    /// What is prescribed besides the vertices that loops hold at their parameters.
    virtual const BoundaryCondition& prescribed() const = 0;
    /// Those vertices, where they are to go, once the start has been made.
    virtual BoundaryCondition marked() const = 0;
    /// Takes other images for prescribed vertices.
    /// @param images as ExtremalSolver has them
    /// @return the loops that slide, with the places of the vertices that are prescribed on them; the others of these
    ///         loops stand anywhere between
    /// @throw Error bad_boundary; nothing has changed then
    virtual std::vector<SlidingLoop> move(const std::vector<Complex>& images) = 0;

    /// What else the result says.
    virtual void record(ExtremalMap&) const {}
    /// Adds what is proved about K*, whatever the iteration has found.
    virtual void prove(ExtremalMap&) const {}

  protected:
    /// @param given    kept by reference
    /// @param prepared given without edges across it between boundary vertices
    /// @param kind     of the vertices between which edges were split
    /// @param shapes   whose charts are taken where the source is one of theirs
    SlidingProblem(const Surface& given, PreparedProblem prepared, int outer_loop, const char* kind,
                   std::vector<const Shape*> shapes = {});

    int outer_loop() const { return outer_loop_; }
    /// Of source(); null if it is none of the shapes.
    const Shape* shape() const;

  private:
    const Surface& given_;
    PreparedProblem prepared_;
    const Surface& source_;
    int outer_loop_;
    const char* kind_;
    std::vector<const Shape*> shapes_;
    mutable std::optional<CircleDomainChart> domain_;
};

}  // namespace beltrami
