#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/evening/dilatation_spread.h>
#include <beltrami/solve/vertex_samples.h>

namespace beltrami {

/// Repairs the few places where |μ| is far from k and sweeps are stuck: Levenberg-Marquardt on the vertices around
/// them, with a steep penalty on outliers; where that fails, a restart from the patch's linear solution, with a growing
/// penalty.
class DilatationPatches {
  public:
    struct Options {
        double outlier = 0.07;    ///< a sample counts as an outlier where | |μ| − k | is above this
        int most_vertices = 300;  ///< larger patches take fewer rings and, if they are still larger, are left alone
    };
    /// All but the options are kept by reference.
    DilatationPatches(const Operators& operators, const VertexSamples& around, const std::vector<Freedom>& freedoms,
                      Options options);

    /// One round over all patches.
    /// @param spread in: of @p f, out: of the moved f
    /// @param rings  of vertices around an outlier's own
    /// @return Levenberg-Marquardt steps; 0 if there was nothing to do
    int run(DilatationSpread& spread, Eigen::VectorXcd& f, int rings) const;

  private:
    /// Free vertices of some samples and of rings around them, ascending.
    std::vector<int> surroundings(const std::vector<int>& samples, int rings) const;
    std::vector<std::vector<int>> find(const DilatationSpread& spread, int rings) const;

    const Operators& operators_;
    const VertexSamples& around_;
    const std::vector<Freedom>& freedoms_;
    Options options_;
};

}  // namespace beltrami
