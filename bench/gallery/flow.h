#pragma once

#include "gallery/gallery.h"

/// What the figures of flows along surfaces share.
namespace beltrami::gallery {

double seconds_now();

/// Options of a flow that goes on until vertices rest.
SurfaceFlowOptions steps_of(FlowScheme scheme, double tolerance = 1e-8);

/// Of a flow in the plane.
Eigen::VectorXcd plane_of(const SurfaceFlowMap& flow);

/// A surface and its image with the same colours, by stereographic coordinates of the image or by a plane map, and the
/// histogram of |μ|.
/// @param curves chains of vertices that are drawn on both
void add_views(Output& output, Picture& picture, const std::string& name, const Mesh& source, const Positions& image,
               const Eigen::VectorXcd& plane, const Eigen::VectorXd& abs_mu, const char* colour, double azimuth,
               double elevation, const std::vector<std::vector<int>>& curves = {});

/// Stereographic coordinates, the south pole cut off.
Eigen::VectorXcd seen_from_south(const Positions& sphere);

/// Steps, mean, std and max of |μ|, flips, seconds.
std::vector<std::string> numbers_of(const SurfaceFlowMap& flow, double seconds);

}  // namespace beltrami::gallery
