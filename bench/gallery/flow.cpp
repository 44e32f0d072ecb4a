#include "gallery/flow.h"

#include <algorithm>
#include <chrono>

namespace beltrami::gallery {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

SurfaceFlowOptions steps_of(FlowScheme scheme, double tolerance) {
    SurfaceFlowOptions options;
    options.scheme = scheme;
    options.tolerance = tolerance;
    options.least_decrease = 0;
    return options;
}

Eigen::VectorXcd plane_of(const SurfaceFlowMap& flow) {
    const Positions images = positions_of(flow.map.points);
    return images.col(0) + Complex(0, 1) * images.col(1);
}

void add_views(Output& output, Picture& picture, const std::string& name, const Mesh& source, const Positions& image,
               const Eigen::VectorXcd& plane, const Eigen::VectorXd& abs_mu, const char* colour, double azimuth,
               double elevation, const std::vector<std::vector<int>>& curves) {
    Mesh there = source;
    there.positions = image;
    there.texture.reset();
    const std::string from = output.write(name, source, plane, abs_mu),
                      to = output.write(name + "_image", there, plane, abs_mu);
    picture.panels.push_back(surface_panel(from, "source", colour, azimuth, elevation, 20, 1, curves));
    picture.panels.push_back(surface_panel(to, "image", colour, azimuth, elevation, 20, 1, curves));
    picture.panels.push_back(histogram_panel({{"", from}}, "|μ|", {}, std::clamp(1.2 * abs_mu.maxCoeff(), 0.05, 1.0)));
}

Eigen::VectorXcd seen_from_south(const Positions& sphere) {
    Eigen::VectorXcd z(sphere.rows());
    for (Eigen::Index v = 0; v < sphere.rows(); ++v)
        z[v] = Complex(sphere(v, 0), sphere(v, 1)) / std::max(1 + sphere(v, 2), 0.05);
    return z;
}

std::vector<std::string> numbers_of(const SurfaceFlowMap& flow, double seconds) {
    const Distortion& d = flow.distortion;
    return {std::to_string(flow.iterations),  number(d.mean),    number(d.standard_deviation), number(d.max),
            std::to_string(d.flipped.size()), number(seconds, 2)};
}

}  // namespace beltrami::gallery
