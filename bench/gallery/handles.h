#pragma once

#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/registration/register_handles.h>

#include "gallery/sliding.h"

/// What the figures of surfaces with handles share.
namespace beltrami::gallery {

/// Head and cells of tables of maps onto a hyperbolic metric.
std::vector<std::string> handle_head(const std::string& first);
/// @param back k of the inverse map; nothing: "–"
std::vector<std::string> handle_row(const std::string& first, const HyperbolicShape& source,
                                    const HyperbolicShape& target, const HyperbolicMap& map,
                                    const std::optional<double>& back);
std::vector<std::string> handle_row(const std::string& first, const HyperbolicShape& source,
                                    const HyperbolicShape& target, const HandleRegistration& found);

/// The fundamental polygon coloured by |μ|, source and image in space with small circles of it, a histogram.
Picture handle_picture(Output& output, const std::string& name, const std::string& caption,
                       const HyperbolicShape& source, const HyperbolicMap& map, double azimuth = 30,
                       double elevation = 60);

/// y multiplied by a function of x.
Mesh stretched(Mesh mesh, const std::function<double(double)>& stretch);

Figure genus_deformed(Output& output);    ///< deformed double tori, and bad starts
Figure genus_twists(Output& output);      ///< Dehn twists
Figure genus_three(Output& output);       ///< three rings
Figure genus_scan(Output& output);        ///< skull_g2.obj, if the folder BELTRAMI_MESHES has it
Figure genus_search(Output& output);      ///< classes that are sought
Figure genus_distance(Output& output);    ///< of double tori, and their clusters
Figure genus_boundary(Output& output);    ///< boundaries that slide, as halves of doubles
Figure genus_open_scans(Output& output);  ///< punctured_torus.obj and alex_3.obj, if the folder has them
Figure genus_starts(Output& output);      ///< of boundaries that slide in the plane

}  // namespace beltrami::gallery
