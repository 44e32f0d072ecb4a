#include "picture_data.h"

#include <cctype>
#include <cmath>
#include <fstream>

#include <beltrami/io/write_mesh.h>

void PictureData::set_folder(const std::filesystem::path& folder) {
    folder_ = folder;
    std::filesystem::create_directories(folder);
}

void PictureData::begin(const std::string& name, double azimuth, double elevation, double most_mu) {
    name_ = name;
    for (char& letter : name_)
        if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
    azimuth_ = azimuth;
    elevation_ = elevation;
    most_mu_ = most_mu;
    panels_.clear();
    curves_ = nlohmann::json::array();
}

void PictureData::add(const std::string& title, const beltrami::Mesh& mesh, Eigen::VectorXd abs_mu) {
    if (folder_.empty()) return;
    for (double& value : abs_mu)
        if (!std::isfinite(value)) value = 1e30;
    const std::string file = name_ + "_" + std::to_string(panels_.size()) + ".ply";
    beltrami::write_mesh(folder_ / file,
                         {mesh, beltrami::Positions::Zero(mesh.vertex_count(), 2), {{"abs_mu", abs_mu}}});
    panels_.emplace_back(title, file);
}

void PictureData::add_curve(const std::string& label, const std::vector<double>& x, const std::vector<double>& y) {
    curves_.push_back({{"label", label}, {"x", x}, {"y", y}});
}

void PictureData::end(const std::string& x_label, const std::string& y_label) {
    if (folder_.empty() || panels_.empty()) return;
    nlohmann::json panels = nlohmann::json::array(), series = nlohmann::json::array();
    for (const auto& [title, file] : panels_) {
        panels.push_back({{"kind", "surface"},
                          {"data", file},
                          {"title", title},
                          {"colour", "mu"},
                          {"azimuth", azimuth_},
                          {"elevation", elevation_},
                          {"squares", 1},
                          {"max", most_mu_},
                          {"highlights", nlohmann::json::array()}});
        series.push_back({{"label", title}, {"data", file}});
    }
    panels.push_back(
        {{"kind", "histogram"}, {"series", series}, {"title", "|μ|"}, {"max", most_mu_}, {"weights", "area"}});
    if (!curves_.empty())
        panels.push_back({{"kind", "curves"},
                          {"series", curves_},
                          {"title", ""},
                          {"x", x_label},
                          {"y", y_label},
                          {"logarithmic", false}});
    pictures_.push_back({{"name", name_}, {"panels", panels}});
    std::ofstream(folder_ / "pictures.json") << pictures_.dump(1) << "\n";
}
