#pragma once

#include <array>
#include <functional>
#include <vector>

#include <beltrami/differentials/sampled_space.h>

namespace beltrami {

/// A quadrature point of a sample's part of its face.
struct FacePoint {
    int sample;
    /// On a triangle the weights of its second and third corner; on a quad the coordinates in the unit square whose
    /// corners (0,0), (1,0), (1,1), (0,1) are the quad's.
    std::array<double, 2> place;
    Complex phi;    ///< φ there, in the sample's frame
    double weight;  ///< area
};

struct QuadratureOptions {
    double variation = 0.25;  ///< φ differing from its mean by more than this part asks for a division ...
    double tolerance = 1e-9;  ///< ... unless the triangle has less than this part of ∫|φ|
    int least_depth = 0;      ///< every triangle is divided so often
    int most_depth = 40;      ///< and no triangle more often
};

/// Calls @p visit for the points of an adaptive quadrature of φ, a combination of @p space: Σ weight·F(φ) is the
/// integral of F. Triangles are divided into four near zeros and poles, and integrated by the rule of degree 4 with six
/// points inside (Dunavant 1985), so that a pole may lie on a vertex. Every Gauss sample of a quad has its quarter of
/// it. With an exact chart positions and derivatives are those of the analytic map at the very points, and φ is
/// holomorphic there; else positions are interpolated and the derivative is the sample's. Samples that the chart
/// excludes take no part. A tabulated space is known at the samples only: each is visited once, with its whole area,
/// and all of ∫|φ| counts as unresolved. The order of the calls does not depend on the number of threads.
/// @param coefficients space.size() of them
/// @return the part of ∫|φ| in triangles that vary too much still, 1 for a tabulated space; infinite if φ is not finite
/// at some
///         point (the visits end there)
double visit_quadrature(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                        const Eigen::VectorXcd& coefficients, const std::function<void(const FacePoint&)>& visit,
                        const QuadratureOptions& options = {});

/// What that quadrature gives on every sample's part of its face.
struct SampleIntegrals {
    Eigen::VectorXcd phi;     ///< #S ∫φ, in the samples' frames; 0 where the chart excludes a sample
    Eigen::VectorXd abs_phi;  ///< #S ∫|φ|
    double unresolved = 0;    ///< what visit_quadrature returns
};

/// ∫φ and ∫|φ| over the samples, as visit_quadrature would add them up.
/// @param coefficients space.size() of them
SampleIntegrals integrals_over_samples(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                                       const Eigen::VectorXcd& coefficients);

/// Points over which φ is averaged on the samples next to curves, pinned points and corners, where one point a sample
/// would let φ see the noise of μ: triangles are divided into four until they are small against their distance from the
/// next such place. None where there is no curve.
SamplePoints points_near(const Singularities& singularities, const Surface& source, const Chart& chart);

/// Where φ is wanted: the points' positions in the canonical domain and the chart's derivative, as above.
ChartPoints chart_points(const Surface& source, const Chart& chart, const std::vector<FacePoint>& points);

}  // namespace beltrami
