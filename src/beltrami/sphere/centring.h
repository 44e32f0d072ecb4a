#pragma once

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Points of the sphere after the Möbius map that puts their centre of mass at the sphere's centre.
struct CentredSphere {
    Positions points;        ///< #V×3 unit vectors
    double centre_distance;  ///< of the centre of mass from the sphere's centre: how far the iteration came
    int iterations = 0;
};

/// The Möbius map is unique up to rotations where no point holds half of the weight. Found by Newton's method on the
/// convex function whose gradient is the centre of mass, a map that only shifts being taken in every step.
/// Source: Baden, Crane, Kazhdan 2018, "Möbius registration"; Milnor's and Douady, Earle's conformal barycentre.
/// @param points  #V×3 unit vectors
/// @param weights #V, not negative; points of weight 0 come along
CentredSphere centred(Positions points, const Eigen::VectorXd& weights);

/// Points of the plane moved and scaled so that the medians of their coordinates are 0 and that of their distances from
/// there is 1: what stereographic projection then spreads over the sphere.
/// @param weights #V; points of weight 0 come along
Eigen::VectorXcd around_median(Eigen::VectorXcd z, const Eigen::VectorXd& weights);

}  // namespace beltrami
