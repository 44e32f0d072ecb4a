#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

/// An extremal problem made ready for the iteration: source, constraints, the f-step, a chart to write φ down in, and
/// the c-step.
class ExtremalProblem {
  public:
    /// Orders and factorises the f-step for the coefficient 0 and solves for the harmonic map.
    /// @param source kept by reference
    /// @param expected_factorizations see SymmetricSolver
    ExtremalProblem(const Surface& source, const BoundaryCondition& boundary, int expected_factorizations);
    ExtremalProblem(const ExtremalProblem&) = delete;

    /// Takes a chart; phase() is known from then on.
    void set_chart(Chart chart);
    /// Takes where φ may be singular, in the chart that was set: the c-step is known from then on.
    void set_singularities(Singularities singularities, int cluster_count);

    const Surface& source() const { return source_; }
    BeltramiSolver& solver() { return solver_; }
    const BeltramiSolver& solver() const { return solver_; }
    FixedMapStep& map_step() { return map_step_; }
    const Eigen::VectorXcd& harmonic() const { return harmonic_; }
    const Chart& chart() const { return chart_; }
    CoefficientStep& coefficient_step() { return *coefficient_step_; }
    /// Whether φ may be singular within reach of the mesh: at corners or pinned points. (Where vertices slide poles and
    /// jumps are mild, and a map that has settled need not be evened out.)
    bool singular() const { return !singularities_.corners.empty() || !singularities_.pins.empty(); }
    /// Whether φ may jump across curves by anything: it takes its time to find by how much, and a map that is evened
    /// out before keeps the error (measured: .0027 in place of .0002).
    bool jumps() const {
        return std::any_of(singularities_.curves.begin(), singularities_.curves.end(),
                           [](const Singularities::Curve& curve) { return !curve.real; });
    }
    /// Rotation of the chart that turns with the source when the boundary values are carried along.
    double phase() const { return phase_; }

    /// A first space for the singularities, which can grow up to a degree.
    std::unique_ptr<DifferentialSpace> starting_space(int largest_degree) const;

  private:
    const Surface& source_;
    BoundaryCondition boundary_;
    BeltramiSolver solver_;
    FixedMapStep map_step_;
    Eigen::VectorXcd harmonic_;
    Chart chart_;
    Singularities singularities_;
    double phase_ = 0;
    std::optional<CoefficientStep> coefficient_step_;
};

/// What the chart's holes, the constraints inside and the corners of domain and boundary values allow φ to have.
/// @param map of which the derivative says where vertices may move that are held to lines one by one; those of curves
///            move along these
Singularities singularities_of(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                               const std::vector<BoundaryCorner>& corners, const Eigen::VectorXcd& map);

/// The vertices that are held to lines one by one, ascending, and the directions of length 1 in which they move in the
/// chart when their images move along the lines: means over the angles at the vertex, as a pole of φ sees them.
struct HeldVertices {
    std::vector<int> vertices;
    std::vector<Complex> directions;
};
HeldVertices held_vertices(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                           const Eigen::VectorXcd& map);

}  // namespace beltrami
