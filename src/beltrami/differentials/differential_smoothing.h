#pragma once

#include <vector>

#include <beltrami/charts/chart.h>

namespace beltrami {

/// Smooths a quadratic differential that a linear solve has found face by face: its noise is as large as φ varies
/// within a face, its means are far better.
///
/// At each vertex a holomorphic polynomial is fitted to the samples around: linear on the star of an inner vertex; at a
/// boundary vertex, where a star is lopsided, quadratic on the stars of its neighbours, and φ τ² is made real. Samples
/// have the means of their vertices. Simple poles at marked points are divided out before and multiplied in again.
class DifferentialSmoothing {
  public:
    /// @param source, chart kept by reference; samples that the chart excludes take no part
    /// @param tangents #V of the boundary in the chart, of length 1
    /// @param marked   vertices with simple poles
    DifferentialSmoothing(const Surface& source, const Chart& chart, Eigen::VectorXcd tangents,
                          const std::vector<int>& marked);

    /// @param phi #S values in the chart
    /// @return #S values in the chart
    Eigen::VectorXcd operator()(const Eigen::VectorXcd& phi) const;

  private:
    /// Π (z − mark).
    Complex pole_factor(Complex z) const;
    /// Weights with which values at samples make up the value at a place.
    struct Fit {
        std::vector<int> samples;
        std::vector<Complex> weights;
    };
    void add_fit(Fit& fit, const std::vector<int>& around, Complex place, int coefficients) const;

    const Surface& source_;
    const Chart& chart_;
    Eigen::VectorXcd squared_tangents_;  ///< #V of φ times the pole factor; 0 where nothing is known
    std::vector<Complex> marks_;
    Eigen::VectorXcd factors_, inverse_factors_;  ///< #S
    /// The value at vertex v is a sum over its samples: offsets[v] … offsets[v+1].
    std::vector<int> offsets_{0}, samples_;
    std::vector<Complex> weights_;
};

}  // namespace beltrami
