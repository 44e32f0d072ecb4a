#pragma once

#include <vector>

#include <beltrami/operators/surface.h>
#include <beltrami/plane/circle_domain.h>

namespace beltrami {

/// A boundary loop on its circle, run through counter-clockwise: holes' loops backwards.
struct CircleRim {
    std::vector<int> vertices;
    int hole = -1;  // index, −1 for the outer loop
    Complex centre = 0;
    double radius = 1;
    std::vector<double> angles;  // increasing, less than a turn
    std::vector<double> least;   // increments
    std::vector<char> held;      // does not slide
    std::vector<char> released;  // once; 1 while it is being done
    std::vector<char> tied;      // keeps its increment to the next one
    int first = 0;               // of its vertices among all rim vertices

    int size() const { return static_cast<int>(vertices.size()); }
    Complex direction(int i) const { return std::polar(1.0, angles[i]); }
    Complex position(int i) const { return centre + radius * direction(i); }
    double increment(int i) const;  ///< angle from a vertex to the next, the last one's to the first
};

/// The boundary loops on their circles, without angles yet.
std::vector<CircleRim> rims_of(const Surface& surface, int outer_loop, const std::vector<RoundHole>& holes);

/// Angles of points on the circles, as they are.
void read_angles(CircleRim& rim, const Eigen::VectorXcd& z);

/// Angles of points near the circles, brought in order, and the rim's least increments.
void choose_angles(CircleRim& rim, const Eigen::VectorXcd& z);

/// #V positions of the rim vertices, 0 elsewhere.
Eigen::VectorXcd rim_positions(const std::vector<CircleRim>& rims, Eigen::Index vertices);

std::vector<RoundHole> holes_of(const std::vector<CircleRim>& rims, int outer_loop);

/// Holds three vertices of the outer loop, about a third of the circle apart.
void hold_three(CircleRim& outer);

/// Chains of tied vertices slide together, by their mean, and not at all with a held one.
/// @param unknowns arc lengths of all rim vertices first
void project(const std::vector<CircleRim>& rims, Eigen::VectorXd& unknowns);

/// The rims after @p length times a step. Sliding is by arc length on the new circle: then angle and radius do not mix
/// in the second derivatives. No increment of angle falls below a tenth or the least one; vertices at the least one
/// become tied.
/// @param step arc lengths of all rim vertices, then centre and radius of every hole
/// @return with a radius ≤ 0, and incomplete, where a hole would vanish
std::vector<CircleRim> moved(std::vector<CircleRim> rims, const Eigen::VectorXd& step, double length);

/// Unties what the energy wants apart; each tie once. The derivative by an increment, the rest of its chain at rest, is
/// the sum of what pulls at the vertices beyond it.
/// @param force derivatives of the energy by the rim vertices
/// @return the number of ties
int release(std::vector<CircleRim>& rims, const Eigen::VectorXcd& force);

}  // namespace beltrami
