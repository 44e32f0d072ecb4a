#pragma once

#include <optional>

#include <beltrami/differentials/chart_grid.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/split_matrix.h>

namespace beltrami {

/// Points that stand for samples where one point a sample is not enough.
struct SamplePoints {
    std::vector<int> samples;  ///< sample of every point, ascending
    ChartPoints points;
    Eigen::VectorXd weights;  ///< parts of the sample: 1 in all
};

/// Rows of the samples that have such points replaced by means over these.
/// @param at_points #points values of functions at the points
/// @param values    #S rows of the same functions
void take_means(const SamplePoints& means, const Eigen::MatrixXcd& at_points, Eigen::MatrixXcd& values);

/// A space of differentials on the samples of a mesh: values of a combination at every sample, and pairings of every
/// basis function with weights at the samples.
///
/// On small meshes the values of all functions at all samples are kept, unless the space computes them as quickly. On
/// large ones, and where that would be many values still, functions are evaluated at four nodes per cell of a grid over
/// the canonical domain only: inside a cell a holomorphic function is its cubic interpolant through four points of a
/// circle. That costs a few operations a sample instead of a few per function and sample; spaces that compute values
/// quickly do so at the nodes each time. Where singularities would ask
/// for nearly as many cells as samples, functions are evaluated afresh each time. A tabulated space is its values at
/// all samples, whatever their number.
class SampledSpace {
  public:
    /// @param chart kept by reference
    /// @param phase rotation of the grid, tied to the data so that turning the source changes nothing
    SampledSpace(const Chart& chart, const Singularities& singularities, double phase);

    /// Values at some samples are means over points of theirs from now on, as far as values are kept for every sample.
    void set_means(SamplePoints means);
    /// The same of spaces of few functions: values are kept for every sample, however many there are.
    void keep_means(SamplePoints means);
    /// The points, none where values are not kept; a combination at them, and pairings with weights at them.
    const SamplePoints& means() const { return means_; }
    Eigen::VectorXcd combination_at_means(const Eigen::VectorXcd& coefficients) const;
    Eigen::MatrixXcd pair_at_means(const Eigen::MatrixXcd& weights) const;

    /// Makes another space the current one; kept by reference until the next call.
    void set(const DifferentialSpace& space);
    const DifferentialSpace& space() const { return *space_; }

    /// Pulled-back values at every sample (#S); 0 where the chart excludes the sample.
    Eigen::VectorXcd combination(const Eigen::VectorXcd& coefficients) const;

    /// Σ_s weights(s, column) φ_j(s) for every function j: size() × #columns. Excluded samples take no part.
    Eigen::MatrixXcd pair(const Eigen::MatrixXcd& weights) const;

  private:
    enum class Mode { dense, interpolated, afresh };

    bool made_afresh(const DifferentialSpace& space) const;
    Mode mode_on_large_mesh();
    Eigen::VectorXcd interpolate(const Eigen::VectorXcd& at_nodes) const;
    Eigen::MatrixXcd gather(const Eigen::MatrixXcd& weights) const;
    ChartPoints chunk(int first, int last) const;

    const Chart& chart_;
    SamplePoints means_;
    const DifferentialSpace* space_ = nullptr;
    double phase_;
    CellSize cell_size_;
    bool large_;                   ///< the mesh
    std::optional<Mode> on_grid_;  ///< of spaces that are not made afresh on a large mesh, once there was one
    Mode mode_ = Mode::dense;      ///< of the current space
    ChartGrid grid_{{}, {0}, {}, {}};
    Eigen::VectorXcd centres_;  ///< #cells
    ChartPoints nodes_;         ///< 4 #cells in the canonical domain
    SplitMatrix at_means_;      ///< of the generators: #points of the means × g
    SplitMatrix values_;        ///< of the generators: #S × g; or #nodes × g; empty where they are computed each time
};

}  // namespace beltrami
