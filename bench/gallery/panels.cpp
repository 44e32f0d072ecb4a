#include <fmt/format.h>

#include <cmath>

#include <beltrami/io/atomic_file.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/report/dendrogram.h>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using nlohmann::json;

Output::Output(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
}

std::string Output::write(const std::string& name, const Surface& surface, const Solved& solved) {
    const bool split = solved.all && solved.all->split && solved.all->split->split_edges > 0;
    return write(name, split ? solved.all->split->mesh : surface.mesh, solved.map, solved.distortion.face_abs_mu);
}

std::string Output::write(const std::string& name, const Mesh& mesh, const Eigen::VectorXcd& images,
                          Eigen::VectorXd values) {
    Positions map(mesh.vertex_count(), 2);
    for (int v = 0; v < mesh.vertex_count(); ++v) map.row(v) << images[v].real(), images[v].imag();
    // What has no |μ| or an infinite one is drawn as flipped.
    for (Eigen::Index f = 0; f < values.size(); ++f)
        if (!std::isfinite(values[f])) values[f] = 1e30;
    write_mesh(folder_ / (name + ".ply"), {mesh, map, {{"abs_mu", values}}});
    return name + ".ply";
}

std::array<std::string, 2> Output::write_cut(const std::string& name, const Mesh& mesh,
                                             const TextureCoordinates& layout, const Positions& image,
                                             const Eigen::VectorXd& values) {
    const Mesh cut = cut_along_seams(mesh, layout);
    Mesh moved = cut;
    for (std::size_t c = 0; c < layout.corners.size(); ++c)
        moved.positions.row(layout.corners[c]) = image.row(mesh.faces.vertices()[c]);
    Eigen::VectorXcd plane(cut.vertex_count());
    for (int v = 0; v < cut.vertex_count(); ++v) plane[v] = {layout.points(v, 0), layout.points(v, 1)};
    return {write(name, cut, plane, values), write(name + "_image", moved, plane, values)};
}

json map_panel(const std::string& data, const std::string& title, double max_mu, const std::string& domain,
               double min_mu) {
    return {{"kind", "map"}, {"data", data}, {"title", title}, {"max", max_mu}, {"domain", domain}, {"min", min_mu}};
}

json grid_panel(const std::string& data, const std::string& title, const std::string& pattern, int count,
                const std::vector<std::vector<int>>& lines) {
    return {{"kind", "grid"}, {"data", data},        {"title", title},    {"pattern", pattern},
            {"count", count}, {"highlights", lines}, {"domain", "image"}, {"segments", json::array()}};
}

json circles_panel(const std::string& data, const std::string& title, const std::string& domain, int count,
                   const std::vector<std::pair<Complex, Complex>>& segments) {
    json panel = grid_panel(data, title, "circles", count);
    panel["domain"] = domain;
    for (const auto& [a, b] : segments) panel["segments"].push_back({{a.real(), a.imag()}, {b.real(), b.imag()}});
    return panel;
}

json histogram_panel(const std::vector<std::pair<std::string, std::string>>& labels_and_data, const std::string& title,
                     std::optional<double> k, double max_mu, const std::string& weights) {
    json series = json::array();
    for (const auto& [label, data] : labels_and_data) series.push_back({{"label", label}, {"data", data}});
    json panel{{"kind", "histogram"}, {"series", series}, {"title", title}, {"max", max_mu}, {"weights", weights}};
    if (k) panel["k"] = *k;
    return panel;
}

json curves_panel(const std::vector<Curve>& curves, const std::string& title, const std::string& x_label,
                  const std::string& y_label, bool logarithmic) {
    json series = json::array();
    for (const Curve& curve : curves) series.push_back({{"label", curve.label}, {"x", curve.x}, {"y", curve.y}});
    return {{"kind", "curves"}, {"series", series}, {"title", title},
            {"x", x_label},     {"y", y_label},     {"logarithmic", logarithmic}};
}

json surface_panel(const std::string& data, const std::string& title, const std::string& colour, double azimuth,
                   double elevation, int squares, double max_mu, const std::vector<std::vector<int>>& highlights) {
    return {{"kind", "surface"},  {"data", data},       {"title", title},
            {"colour", colour},   {"azimuth", azimuth}, {"elevation", elevation},
            {"squares", squares}, {"max", max_mu},      {"highlights", highlights}};
}

json lines_panel(const std::vector<Lines>& groups, const std::string& title,
                 const std::vector<std::pair<Complex, std::string>>& labels) {
    json list = json::array(), texts = json::array();
    for (const Lines& group : groups) {
        json lines = json::array();
        for (const auto& line : group.lines) {
            if (line.size() < 2) continue;
            json points = json::array();
            for (const Complex p : line) points.push_back({p.real(), p.imag()});
            lines.push_back(std::move(points));
        }
        if (!lines.empty())
            list.push_back({{"colour", group.colour}, {"width", group.width}, {"lines", std::move(lines)}});
    }
    for (const auto& [place, text] : labels) texts.push_back({place.real(), place.imag(), text});
    return {{"kind", "lines"}, {"groups", std::move(list)}, {"labels", std::move(texts)}, {"title", title}};
}

json faces_panel(const std::string& data, const std::string& title) {
    return {{"kind", "faces"}, {"data", data}, {"title", title}};
}

json svg_panel(const std::string& file) {
    return {{"kind", "svg"}, {"data", file}, {"title", ""}};
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "–";
    if (std::isinf(value)) return "∞";
    return fmt::format("{:.{}f}", value, digits);
}

std::string scientific(double value) {
    return fmt::format("{:.1e}", value);
}

std::vector<std::string> usual_head(const std::string& first) {
    return {first, "k", "K_lower", "K", "mean abs(μ)", "std", "p99", "max", "flips", "iterations", "seconds"};
}

std::vector<std::string> usual_row(const std::string& first, const Solved& solved) {
    if (!solved) return {first, "refused: " + solved.refusal, "", "", "", "", "", "", "", "", ""};
    const Distortion& d = solved.distortion;
    return {first,
            solved.k ? number(*solved.k) : "",
            solved.K_lower ? number(*solved.K_lower) : "",
            solved.K ? number(*solved.K) : "",
            number(d.mean),
            number(d.standard_deviation),
            number(d.p99),
            number(d.max, 3),
            std::to_string(d.flipped.size()),
            (solved.iterations > 0 ? std::to_string(solved.iterations) : "") +
                (solved.end.empty() || solved.end == "converged" ? "" : " (" + solved.end + ")"),
            solved.seconds > 0 ? number(solved.seconds, 2) : ""};
}

void add_distances(Output& output, Figure& figure, const std::string& name, const std::vector<std::string>& names,
                   const DistanceMatrix& found, const std::string& caption) {
    Table table{caption, {""}, {}};
    table.head.insert(table.head.end(), names.begin(), names.end());
    for (Eigen::Index i = 0; i < found.distance.rows(); ++i) {
        std::vector<std::string> row{names[static_cast<std::size_t>(i)]};
        for (Eigen::Index j = 0; j < found.distance.cols(); ++j)
            row.push_back(i == j ? "0"
                                 : number(found.distance(i, j)) + " (" + number(found.lower(i, j)) + " to " +
                                       number(found.upper(i, j)) + ")");
        table.rows.push_back(std::move(row));
    }
    figure.tables.push_back(std::move(table));
    write_atomically(output.folder() / (name + ".svg"),
                     render_dendrogram(names, found.distance, cluster_by_distance(found.distance)));
    figure.pictures.push_back({name, "The matrix and the tree of its clusters.", {svg_panel(name + ".svg")}});
}

}  // namespace beltrami::gallery
