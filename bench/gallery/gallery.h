#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>

#include "support/problems.h"

/// The gallery: figures of maps with their numbers. A figure is one function that solves, writes data and describes its
/// pictures; draw.py draws them.
namespace beltrami::gallery {

/// Rows of a table in Markdown. No cell holds a vertical bar.
struct Table {
    std::string caption;  ///< a paragraph before the table; may be empty
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// One PNG: panels side by side, see the builders below.
struct Picture {
    std::string name;     ///< without extension
    std::string caption;  ///< one sentence
    std::vector<nlohmann::json> panels;
    int columns = 4;  ///< panels in a row
};

/// One section of docs/gallery.md.
struct Figure {
    std::string title;      ///< "Figures 7 and 8: …"
    std::string statement;  ///< what the paper states there
    std::vector<Table> tables = {};
    std::vector<Picture> pictures = {};
    std::vector<std::string> remarks = {};  ///< paragraphs after the tables
};

/// A map with its numbers, or why there is none.
struct Solved {
    std::string method;
    Eigen::VectorXcd map;  ///< empty: refused
    Distortion distortion = {};
    std::optional<double> k, K_lower;
    int iterations = 0;
    double seconds = 0;
    std::string refusal;  ///< the error's sentence

    explicit operator bool() const { return map.size() > 0; }
};

/// Solves with a method; an Error becomes a refusal, so that a figure shows what is possible today.
Solved solve(const Surface& surface, const BoundaryCondition& boundary, const std::string& method);
/// Any other way to a map.
Solved solve_with(const Surface& surface, const std::string& method, const std::function<Eigen::VectorXcd()>& map);

/// Where data files go.
class Output {
  public:
    /// @param folder for data files, made if need be
    explicit Output(std::filesystem::path folder);
    /// Writes mesh, map (u, v) and |μ| of the faces as NAME.ply; returns the file's name.
    std::string write(const std::string& name, const Surface& surface, const Solved& solved);
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

// Panels. |μ| is coloured from 0 to max_mu, flipped faces are red.
/// The image of a map; domain "source": the planar source itself with the colours of the map.
nlohmann::json map_panel(const std::string& data, const std::string& title, double max_mu = 1,
                         const std::string& domain = "image");
/// The image of a planar mesh with a polar chessboard of the source, 24 sectors and rings of their shape.
nlohmann::json grid_panel(const std::string& data, const std::string& title);
/// Histograms of |μ|, one line each; a vertical line at k.
nlohmann::json histogram_panel(const std::vector<std::pair<std::string, std::string>>& labels_and_data,
                               const std::string& title, std::optional<double> k = {}, double max_mu = 1);
/// Curves in logarithmic axes.
struct Curve {
    std::string label;
    std::vector<double> x, y;
};
nlohmann::json curves_panel(const std::vector<Curve>& curves, const std::string& title, const std::string& x_label,
                            const std::string& y_label);
/// The source in space. colour "checker" (squares of the map's plane, so many to the larger side of its image) or "mu".
nlohmann::json surface_panel(const std::string& data, const std::string& title, const std::string& colour,
                             double azimuth, double elevation, int squares = 20, double max_mu = 1,
                             const std::vector<std::vector<int>>& highlights = {});

/// Numbers for tables.
std::string number(double value, int digits = 4);
/// Head and cells that most tables share: method, k, K_lower, mean and std of |μ|, p99, max, flips, iterations.
std::vector<std::string> usual_head(const std::string& first);
std::vector<std::string> usual_row(const std::string& first, const Solved& solved);

/// A figure by its short name.
struct Entry {
    std::string name;
    Figure (*make)(Output&);
};
/// All figures in the order of the page.
const std::vector<Entry>& figures();

Figure figure_02(Output& output);  ///< homotopy classes
Figure figure_03(Output& output);  ///< a map that is extremal and not of Teichmüller type
Figure figure_07(Output& output);  ///< known maps and prescribed boundary values, and convergence (with Fig. 8)
Figure figure_09(Output& output);  ///< zeros of the differential appear
Figure figure_10(Output& output);  ///< dependence on the start
Figure figure_11(Output& output);  ///< direct minimisation of powers
Figure figure_12(Output& output);  ///< aligned features
Figure figure_13(Output& output);  ///< a multiply connected curved surface
Figure figure_14(Output& output);  ///< image deformation
Figure figure_15(Output& output);  ///< other energies
Figure figure_16(Output& output);  ///< regular and irregular meshes
Figure figure_17(Output& output);  ///< few triangles
Figure figure_19(Output& output);  ///< a ball with twelve holes

}  // namespace beltrami::gallery
