#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/teichmuller/chart_metric.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

/// An extremal problem made ready for the iteration: source, constraints, the f-step, a chart to write φ down in, and
/// the c-step.
class ExtremalProblem {
  public:
    /// Orders and factorises the f-step for the coefficient 0 and solves for the harmonic map.
    /// @param source kept by reference
    /// @param expected_factorizations see ElementSystem
    ExtremalProblem(const Surface& source, const BoundaryCondition& boundary, int expected_factorizations);
    ExtremalProblem(const ExtremalProblem&) = delete;

    /// Takes other boundary values for the same vertices, and the harmonic map with them, as long as the solver's
    /// factorisation is that of the coefficient 0.
    void set_boundary(const BoundaryCondition& boundary);
    /// Takes a chart; phase() is known from then on.
    void set_chart(Chart chart);
    /// Whether the source is a disk in space, or with a metric of its own, of which only the boundary is prescribed.
    bool is_disk_in_space() const;
    /// Whether the plane of the chart that was set can be the metric of the iteration: of a disk in space whose chart
    /// turns over next to nothing of itself.
    bool chart_metric_possible() const;
    /// The k that the surface's metric would give the chart itself, as part of that of the harmonic map
    /// (chart_metric.h).
    double chart_noise(int cluster_count) const;
    /// Takes the plane of the chart as the metric of the iteration.
    /// @pre chart_metric_possible()
    void take_chart_metric();
    /// Takes where φ may be singular, in the chart that was set: the c-step is known from then on.
    /// @param sums see CoefficientStep
    void set_singularities(Singularities singularities, int cluster_count, CoefficientStep::Sums sums);
    /// The same, on cells in the plane of a chart, where the rim's noise is larger than what cells leave out.
    void set_singularities(Singularities singularities, int cluster_count);

    const Surface& source() const { return source_; }
    /// The surface with the metric of the iteration: the source, or the plane of its chart.
    const Surface& domain() const { return chart_metric_ ? chart_metric_->plane() : source_; }
    /// Null where the metric of the iteration is the source's own.
    const ChartMetric* chart_metric() const { return chart_metric_.get(); }
    /// φ of domain() in the source's frames, and coefficients of maps of domain() as coefficients on the source.
    Eigen::VectorXcd differential_on_source(const Eigen::VectorXcd& phi) const {
        return chart_metric_ ? chart_metric_->differential_on_surface(phi) : phi;
    }
    /// A combination of a space of chart(), on the source.
    QuadraticDifferential differential(std::shared_ptr<const DifferentialSpace> space,
                                       Eigen::VectorXcd coefficients) const;
    Eigen::VectorXcd coefficient_on_source(const Eigen::VectorXcd& nu) const {
        return chart_metric_ ? chart_metric_->coefficient_on_surface(nu) : nu;
    }
    BeltramiSolver& solver() { return solver_; }
    const BeltramiSolver& solver() const { return solver_; }
    FixedMapStep& map_step() { return map_step_; }
    /// The f-step for coefficients in domain().
    MapStep& step_in_domain();
    const Eigen::VectorXcd& harmonic() const { return harmonic_; }
    /// Of domain().
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

    /// Whether the chart is that of a round disk.
    bool chart_is_round() const;
    /// The largest degree of φ that the mesh resolves, and where the chart is round its rim too.
    int largest_degree() const;
    /// Lets φ have a degree beyond what smooth data ask for, where mesh and rim resolve it.
    void allow_degree(int most) { most_degree_ = most; }
    /// A first space for the singularities, which can grow up to a degree. In the plane of a chart, where no noise
    /// forbids it and poles come to a map that has settled without them, it has grown at once.
    std::unique_ptr<DifferentialSpace> starting_space(int largest_degree) const;

  private:
    /// The f-step on the source for coefficients in the plane of its chart.
    class StepInChart final : public MapStep {
      public:
        StepInChart(PlaneMapStep& step, const ChartMetric& metric) : step_(step), metric_(metric) {}
        void solve(const Eigen::VectorXcd& nu, double tolerance) override {
            step_.solve(metric_.coefficient_on_surface(nu), tolerance);
        }
        MapDerivatives derivatives() const override {
            return beltrami::derivatives(metric_.plane().operators, step_.map());
        }
        std::any snapshot() const override { return step_.snapshot(); }
        void restore(const std::any& snapshot) override { step_.restore(snapshot); }

      private:
        PlaneMapStep& step_;
        const ChartMetric& metric_;
    };

    const Surface& source_;
    BoundaryCondition boundary_;
    BeltramiSolver solver_;
    FixedMapStep map_step_;
    Eigen::VectorXcd harmonic_;
    Chart chart_;
    std::unique_ptr<ChartMetric> chart_metric_;
    std::optional<StepInChart> step_in_chart_;
    Singularities singularities_;
    double phase_ = 0;
    int most_degree_ = PolynomialSpace::kMostDegree;
    std::optional<CoefficientStep> coefficient_step_;
};

/// Whether the plane of a chart can be the metric of the iteration: of a disk whose round chart turns over next to
/// nothing of itself.
bool can_be_metric(const Surface& source, const Chart& chart);

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
