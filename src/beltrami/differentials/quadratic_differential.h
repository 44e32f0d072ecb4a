#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/singularities.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A holomorphic quadratic differential φ on a surface: a combination of the functions of a space, written down in a
/// chart.
struct QuadraticDifferential {
    std::shared_ptr<const DifferentialSpace> space;  ///< null: φ = 0
    std::shared_ptr<const Chart> chart;              ///< in which the space is written down; null with the space
    Eigen::VectorXcd coefficients;                   ///< space->size() of them
    std::vector<int> poles;                          ///< vertices at which φ may have a simple pole, ascending
    std::vector<int> jumps;                          ///< vertices on curves across which φ may jump, ascending

    bool zero() const { return !space || (coefficients.array() == 0.0).all(); }
    /// Whether φ is known at the samples only.
    bool tabulated() const { return space && space->tabulated(); }

    /// Values at the samples in their frames: #S; 0 where the chart says nothing.
    Eigen::VectorXcd at_samples(const Surface& source) const;
    /// Values at any points of the canonical domain, pulled back by their derivatives.
    /// @pre not tabulated()
    Eigen::VectorXcd at(const ChartPoints& points) const;
    /// Values at any places of the surface, in the frame of the nearest sample of their face. Between the samples of a
    /// tabulated φ the value of the nearest one is taken.
    Eigen::VectorXcd at(const Surface& source, std::span<const MeshPoint> places) const;
};

/// A combination of a space, with the vertices of the singularities that the space was made for.
/// @param chart in which the singularities are given; copied
QuadraticDifferential differential_of(std::shared_ptr<const DifferentialSpace> space, const Chart& chart,
                                      Eigen::VectorXcd coefficients, const Singularities& singularities);

/// φ(z) dz² of one's own on a planar source, in the coordinates of its plane (seen from the side from which its faces
/// run counter-clockwise).
/// @param phi   holomorphic where the source lies; called on all threads
/// @param poles vertices at which it has simple poles
/// @throw Error bad_mesh unless the source lies in the plane
QuadraticDifferential differential_of(const Surface& source, std::function<Complex(Complex)> phi,
                                      std::vector<int> poles = {});

/// φ of one's own from its values at the samples, in their frames.
/// @param values #S
/// @throw Error bad_option if they are not #S finite numbers
QuadraticDifferential differential_of(const Surface& source, const Eigen::VectorXcd& values,
                                      std::vector<int> poles = {});

/// Positions of places in the chart, and its derivative at the nearest sample of their face, or at the place itself
/// where the chart is known everywhere.
ChartPoints chart_points(const Surface& source, const Chart& chart, std::span<const MeshPoint> places);

/// The sample nearest to a place of a face: its own of a triangle, the Gauss point of the corner with the largest
/// weight of a quad.
/// @return #places
std::vector<int> nearest_samples(const Surface& source, std::span<const MeshPoint> places);

}  // namespace beltrami
