#include <fmt/format.h>

#include <cmath>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using nlohmann::json;

Output::Output(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
}

std::string Output::write(const std::string& name, const Surface& surface, const Solved& solved) {
    Positions map(surface.mesh.vertex_count(), 2);
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) map.row(v) << solved.map[v].real(), solved.map[v].imag();
    // What has no |μ| or an infinite one is drawn as flipped.
    Eigen::VectorXd size = solved.distortion.face_abs_mu;
    for (Eigen::Index f = 0; f < size.size(); ++f)
        if (!std::isfinite(size[f])) size[f] = 1e30;
    write_mesh(folder_ / (name + ".ply"), {surface.mesh, map, {{"abs_mu", size}}});
    return name + ".ply";
}

json map_panel(const std::string& data, const std::string& title, double max_mu, const std::string& domain) {
    return {{"kind", "map"}, {"data", data}, {"title", title}, {"max", max_mu}, {"domain", domain}};
}

json grid_panel(const std::string& data, const std::string& title) {
    return {{"kind", "grid"}, {"data", data}, {"title", title}};
}

json histogram_panel(const std::vector<std::pair<std::string, std::string>>& labels_and_data, const std::string& title,
                     std::optional<double> k, double max_mu) {
    json series = json::array();
    for (const auto& [label, data] : labels_and_data) series.push_back({{"label", label}, {"data", data}});
    json panel{{"kind", "histogram"}, {"series", series}, {"title", title}, {"max", max_mu}};
    if (k) panel["k"] = *k;
    return panel;
}

json curves_panel(const std::vector<Curve>& curves, const std::string& title, const std::string& x_label,
                  const std::string& y_label) {
    json series = json::array();
    for (const Curve& curve : curves) series.push_back({{"label", curve.label}, {"x", curve.x}, {"y", curve.y}});
    return {{"kind", "curves"}, {"series", series}, {"title", title}, {"x", x_label}, {"y", y_label}};
}

json surface_panel(const std::string& data, const std::string& title, const std::string& colour, double azimuth,
                   double elevation, int squares, double max_mu, const std::vector<std::vector<int>>& highlights) {
    return {{"kind", "surface"},  {"data", data},       {"title", title},
            {"colour", colour},   {"azimuth", azimuth}, {"elevation", elevation},
            {"squares", squares}, {"max", max_mu},      {"highlights", highlights}};
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "–";
    if (std::isinf(value)) return "∞";
    return fmt::format("{:.{}f}", value, digits);
}

std::vector<std::string> usual_head(const std::string& first) {
    return {first, "k", "K_lower", "mean abs(μ)", "std", "p99", "max", "flips", "iterations"};
}

std::vector<std::string> usual_row(const std::string& first, const Solved& solved) {
    if (!solved) return {first, "refused: " + solved.refusal, "", "", "", "", "", "", ""};
    const Distortion& d = solved.distortion;
    return {first,
            solved.k ? number(*solved.k) : "",
            solved.K_lower ? number(*solved.K_lower) : "",
            number(d.mean),
            number(d.standard_deviation),
            number(d.p99),
            number(d.max, 3),
            std::to_string(d.flipped.size()),
            solved.iterations > 0 ? std::to_string(solved.iterations) : ""};
}

}  // namespace beltrami::gallery
