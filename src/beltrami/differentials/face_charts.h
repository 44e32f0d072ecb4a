#pragma once

#include <array>
#include <vector>

#include <beltrami/charts/chart.h>

namespace beltrami {

/// The triangles of a sphere's atlas in charts of their own: stereographic, with the face's middle in the centre. The
/// linear map of a face to its chart misses being conformal by the second order in its size, where that to a chart
/// common to many faces does by the first.
class FaceCharts {
  public:
    /// @param source kept by reference
    /// @param chart  by make_atlas() of places of sphere/atlas.h
    FaceCharts(const Surface& source, const Chart& chart);

    /// Where a point of a triangle is in the atlas, and the derivative of the map there in the sample's frame.
    /// @param barycentric by the face's corners
    std::array<Complex, 2> at(int sample, int face, const std::array<double, 3>& barycentric) const;

  private:
    double offset(int face) const;

    const FaceList& faces_;
    Operators operators_;      // per corner
    Eigen::VectorXcd places_;  // of the corners, each in its face's chart
    std::vector<Complex> middles_;
    std::vector<char> south_;
};

}  // namespace beltrami
