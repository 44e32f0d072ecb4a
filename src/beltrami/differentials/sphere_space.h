#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/charts/chart.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/sampled_space.h>

namespace beltrami {

/// The quadratic differentials on the sphere with at most simple poles at n ≥ 4 landmarks, of complex dimension n − 3,
/// in the atlas of sphere/atlas.h. With spinors (ξ, η) of a point and (ξ_i, η_i) of the landmarks the generators are
///
///     φ_j = dζ² / Π_{i ∈ {1,2,3,j}} (ξ η_i − ξ_i η),    ζ the coordinate of the chart, j = 4 … n,
///
/// that is dz²/Π(z − a_i), without a special case at infinity. The basis is orthonormal in Σ A φ_i conj(φ_j)/ρ,
/// ρ = Σ|φ_j|, in which squares of simple poles can be integrated.
class SphereSpace final : public DifferentialSpace {
  public:
    /// @param landmarks #L×3 unit vectors, distinct, at least 4
    /// @param chart     of the source by make_atlas(); not kept
    /// @param means     points of the samples that have several
    SphereSpace(const Surface& source, const Chart& chart, const Positions& landmarks, const SamplePoints& means);

    int size() const override { return static_cast<int>(order_.size()) - 3; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    const Eigen::MatrixXcd* transform() const override { return &transform_; }
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    std::vector<std::array<Complex, 2>> spinors_;
    std::vector<int> order_;  // of the landmarks: the first three far apart
    Eigen::MatrixXcd transform_;
};

/// Points for the samples of φ with simple poles at landmarks: at these the conical product of Gauss rules with its
/// apex at the landmark, under which 1/r becomes smooth, 9 a triangle, 18 a quarter of a quad; symmetric rules on
/// triangles around them (6 points, degree 4) and on all others (3, degree 2): with one point there the far faces would
/// leave an error of the first order in the mesh width. The four samples of a quad are exact enough.
/// @param chart by make_atlas()
/// @param rings of faces beyond those at the landmarks that count as around them
SamplePoints conical_points(const Surface& source, const Chart& chart, std::span<const int> landmarks, int rings);

}  // namespace beltrami
