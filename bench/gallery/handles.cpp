#include "gallery/handles.h"

#include <beltrami/mesh/texture_map.h>

namespace beltrami::gallery {

std::vector<std::string> handle_head(const std::string& first) {
    return {first,
            "vertices",
            "k",
            "k back",
            "k in space",
            "bracket of K",
            "homology",
            "std",
            "max",
            "steps",
            "flips, hyperbolic / in space"};
}

std::vector<std::string> handle_row(const std::string& first, const HyperbolicShape& source,
                                    const HyperbolicShape& target, const HyperbolicMap& map,
                                    const std::optional<double>& back) {
    return {first,
            std::to_string(source.surface().mesh.vertex_count()) + ", " +
                std::to_string(target.surface().mesh.vertex_count()),
            number(map.k, 5),
            back ? number(*back, 5) : "–",
            number(map.k_in_space),
            map.one_to_one() ? number(map.K_lower) + "–" + number(map.K_upper) : "none",
            number(map.K_homology) + (map.K_homology > map.K ? " > K " + number(map.K) : ""),
            number(map.weighted_deviation),
            number(map.distortion.max, 3),
            std::to_string(map.history.size() - 1),
            std::to_string(map.distortion.flipped.size()) + " / " + std::to_string(map.in_space.flipped.size())};
}

std::vector<std::string> handle_row(const std::string& first, const HyperbolicShape& source,
                                    const HyperbolicShape& target, const HandleRegistration& found) {
    return handle_row(first, source, target, found.map, found.inverse_k);
}

Picture handle_picture(Output& output, const std::string& name, const std::string& caption,
                       const HyperbolicShape& source, const HyperbolicMap& map, double azimuth, double elevation) {
    const Surface& surface = source.surface();
    const HyperbolicDomain domain = hyperbolic_domain(surface, source.metric());
    const auto [here, there] =
        output.write_cut(name, surface.mesh, domain.layout, map.positions, map.distortion.face_abs_mu);
    const double shown = std::clamp(1.6 * map.k, 0.05, 1.0);
    return {name,
            caption,
            {map_panel(here, "|μ| on a fundamental polygon", shown),
             surface_panel(here, "source", "circles", azimuth, elevation, 60),
             surface_panel(there, "its image", "circles", azimuth, elevation, 60),
             histogram_panel({{"", here}}, "|μ| of the source's faces", map.k, shown)}};
}

Mesh stretched(Mesh mesh, const std::function<double(double)>& stretch) {
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions(v, 1) *= stretch(mesh.positions(v, 0));
    return mesh;
}

}  // namespace beltrami::gallery
