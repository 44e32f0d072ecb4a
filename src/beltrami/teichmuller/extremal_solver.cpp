#include <beltrami/teichmuller/extremal_solver.h>

#include <beltrami/base/error.h>
#include <beltrami/teichmuller/mixed_conditions.h>
#include <beltrami/teichmuller/mixed_in_chart.h>
#include <beltrami/teichmuller/onto_problem.h>
#include <beltrami/teichmuller/piecewise_solver.h>
#include <beltrami/teichmuller/prescribed_solver.h>
#include <beltrami/teichmuller/sliding_solver.h>

namespace beltrami {

namespace {

std::unique_ptr<ProblemSolver> prescribed_solver(const Surface& source, const Constraints& constraints,
                                                 const ExtremalOptions& options) {
    PreparedProblem prepared = prepare(source, constraints, options);
    const Correspondence& wanted = constraints.correspondence;
    ProblemPieces cut;
    // A class that is asked for is one of the whole.
    if (wanted.turns.empty() && !wanted.waypoints) cut = pieces_of(prepared.surface_of(source), constraints.prescribed);
    if (!cut.pieces.empty())
        return std::make_unique<PiecewiseSolver>(source, constraints, options, std::move(prepared),
                                                 std::move(cut.pieces));
    return std::make_unique<PrescribedSolver>(source, constraints, options, std::move(prepared), cut.obstacle);
}

std::unique_ptr<ProblemSolver> solver_of(const Surface& source, const Constraints& constraints,
                                         const ExtremalOptions& options) {
    if (constraints.all_prescribed()) return prescribed_solver(source, constraints, options);
    if (constraints.all_slides())
        return std::make_unique<SlidingSolver>(std::make_unique<OntoProblem>(source, constraints, options), options);
    return mixed_solver(source, mixed_conditions(source, constraints, options.target_edge_length), options,
                        constraints.correspondence.marks.size());
}

}  // namespace

ExtremalSolver::ExtremalSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options)
    : solver_(solver_of(source, constraints, options)) {}
ExtremalSolver::~ExtremalSolver() = default;
ExtremalSolver::ExtremalSolver(ExtremalSolver&&) noexcept = default;

ExtremalSolver::Update ExtremalSolver::update(const std::vector<Complex>& images, int max_iterations) {
    if (max_iterations < 1) throw Error(Cause::bad_option, "an update needs at least one iteration");
    return solver_->update(images, max_iterations);
}

ExtremalMap ExtremalSolver::solve() {
    return solver_->solve();
}

}  // namespace beltrami
