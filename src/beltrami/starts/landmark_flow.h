#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Smooth tangent vector fields on the sphere that take given values at landmarks: the tangential part of
/// Σ exp(−|x − x_j|²/2s²) w_j.
class LandmarkField {
  public:
    /// @param landmarks  #L×3 unit vectors
    /// @param velocities #L×3, tangent there
    /// @param width      s, in units of the sphere's radius
    LandmarkField(Positions landmarks, const Positions& velocities, double width);

    Eigen::RowVector3d at(const Eigen::RowVector3d& point) const;
    /// #V×3
    Positions at(const Positions& points) const;

  private:
    Positions landmarks_, weights_;
    double scale_;  // 1/2s²
};

/// Points on the great circles from points to points (#L×3 both), at times from 0 to 1.
Positions along_great_circles(const Positions& from, const Positions& to, double time);

/// 0.6 times the median distance of landmarks from the next one, at most 0.6.
double landmark_width(const Positions& from, const Positions& to);

/// Moves all points of the sphere by a flow that takes landmarks along great circles from stop to stop: a
/// diffeomorphism that knows nothing of a mesh, and so the start of a homotopy class.
/// @param points #V×3 unit vectors
/// @param stops  #L×3 each, the first where the landmarks are
/// @param steps  of the midpoint rule from one stop to the next
/// @param width  of the fields; nothing: landmark_width() of the two stops
Positions landmark_flow(Positions points, const std::vector<Positions>& stops, int steps,
                        std::optional<double> width = {});

}  // namespace beltrami
