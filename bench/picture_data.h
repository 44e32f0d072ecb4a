#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

/// Data of pictures in a folder, which gallery/draw.py draws: draw.py FOLDER PICTURES. Without a folder nothing is
/// written.
class PictureData {
  public:
    void set_folder(const std::filesystem::path& folder);

    /// A picture: surfaces side by side, coloured by |μ|, then its histogram.
    /// @param most_mu where colours and histogram end
    void begin(const std::string& name, double azimuth, double elevation, double most_mu);
    /// A panel of it, if a folder is there.
    /// @param abs_mu #F; beyond 1 red
    void add(const std::string& title, const beltrami::Mesh& mesh, Eigen::VectorXd abs_mu);
    /// A line of the picture's second diagram.
    void add_curve(const std::string& label, const std::vector<double>& x, const std::vector<double>& y);
    /// Ends the picture, and writes the list of all of them.
    void end(const std::string& x_label = "", const std::string& y_label = "");

  private:
    std::filesystem::path folder_;
    std::string name_;
    double azimuth_ = 0, elevation_ = 0, most_mu_ = 1;
    std::vector<std::pair<std::string, std::string>> panels_;
    nlohmann::json curves_ = nlohmann::json::array(), pictures_ = nlohmann::json::array();
};
