#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>

#include "problems/problems.h"

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
};

/// One section of a page. Without a title: not made, the section stays as it is.
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
    std::optional<double> k, K, K_lower;
    int iterations = 0;
    std::string end;                 ///< of an extremal map: "converged", …
    std::optional<ExtremalMap> all;  ///< of an extremal map
    double seconds = 0;
    std::string refusal;  ///< the error's sentence

    explicit operator bool() const { return map.size() > 0; }
};

/// Solves with "harmonic", "ARAP", "MIPS", "least maximum", "extremal" or "not evened" (the extremal map as the
/// iteration leaves it); an Error becomes a refusal, so that a figure
/// shows what is possible today.
/// @param options of extremal and least maximum; without a wish for `sharpen` bounds are those of quadratic maps
Solved solve(const Surface& surface, const Constraints& constraints, const std::string& method,
             ExtremalOptions options = {});
/// Seconds of a harmonic map of this problem, the best of three.
double harmonic_seconds(const Surface& surface, const BoundaryCondition& boundary);
/// Any other way to a map.
Solved solve_with(const Surface& surface, const std::string& method, const std::function<Eigen::VectorXcd()>& map);

/// Where data files go.
class Output {
  public:
    /// @param folder for data files, made if need be
    explicit Output(std::filesystem::path folder);
    /// Writes mesh (that of the map, if edges were split), map (u, v) and |μ| of the faces as NAME.ply; returns the
    /// file's name.
    std::string write(const std::string& name, const Surface& surface, const Solved& solved);
    /// The same with other values of the faces in place of |μ|.
    std::string write(const std::string& name, const Mesh& mesh, const Eigen::VectorXcd& map, Eigen::VectorXd values);
    /// A closed surface cut open along the seams of a layout, and its image in space cut likewise; the files' names.
    /// @param image #V×3 where the surface's vertices go
    std::array<std::string, 2> write_cut(const std::string& name, const Mesh& mesh, const TextureCoordinates& layout,
                                         const Positions& image, const Eigen::VectorXd& values);
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

// Panels. |μ| is coloured from 0 (or min_mu) to max_mu, flipped faces are red.
/// The image of a map; domain "source": the planar source itself with the colours of the map.
nlohmann::json map_panel(const std::string& data, const std::string& title, double max_mu = 1,
                         const std::string& domain = "image", double min_mu = 0);
/// The image of a planar mesh with a checkerboard of the source. pattern "polar": sectors and rings of their shape;
/// "disk": sectors and rings of equal width; "square": so many squares to the larger side of the source.
/// @param lines chains of vertices to draw
/// "circles": small circles, so many to the larger side; "doughnut": a picture on .4 < |z| < 1.
nlohmann::json grid_panel(const std::string& data, const std::string& title, const std::string& pattern = "polar",
                          int count = 24, const std::vector<std::vector<int>>& lines = {});
/// Small circles of the source, so many to its larger side, on the source or on the image.
/// @param segments straight lines of the source to draw, each with its own colour
nlohmann::json circles_panel(const std::string& data, const std::string& title, const std::string& domain, int count,
                             const std::vector<std::pair<Complex, Complex>>& segments = {});
/// Histograms of |μ|, one line each; a vertical line at k.
/// @param weights "area", or "triangles": every triangle counts alike
nlohmann::json histogram_panel(const std::vector<std::pair<std::string, std::string>>& labels_and_data,
                               const std::string& title, std::optional<double> k = {}, double max_mu = 1,
                               const std::string& weights = "area");
/// Curves, in logarithmic axes unless told otherwise.
struct Curve {
    std::string label;
    std::vector<double> x, y;
};
nlohmann::json curves_panel(const std::vector<Curve>& curves, const std::string& title, const std::string& x_label,
                            const std::string& y_label, bool logarithmic = true);
/// The source in space. colour "checker" (squares of the map's plane, so many to the larger side of its image),
/// "circles" (small circles of that plane), "faces" (the edges of the mesh) or "mu".
nlohmann::json surface_panel(const std::string& data, const std::string& title, const std::string& colour,
                             double azimuth, double elevation, int squares = 20, double max_mu = 1,
                             const std::vector<std::vector<int>>& highlights = {});

/// Chains of points of the plane in one colour of matplotlib's.
struct Lines {
    std::string colour;
    double width;
    std::vector<std::vector<Complex>> lines;
};
nlohmann::json lines_panel(const std::vector<Lines>& groups, const std::string& title,
                           const std::vector<std::pair<Complex, std::string>>& labels = {});

/// The image of a map with the edges of its faces.
nlohmann::json faces_panel(const std::string& data, const std::string& title);
/// An SVG file of the data folder, a picture of its own.
nlohmann::json svg_panel(const std::string& file);

/// Numbers for tables.
std::string number(double value, int digits = 4);
std::string scientific(double value);  ///< 1.2e-05
/// Head and cells that most tables share.
std::vector<std::string> usual_head(const std::string& first);
std::vector<std::string> usual_row(const std::string& first, const Solved& solved);

/// A matrix of distances with its bounds as a table, and the tree of its clusters as a picture of that name.
void add_distances(Output& output, Figure& figure, const std::string& name, const std::vector<std::string>& names,
                   const DistanceMatrix& found, const std::string& caption = "");

/// Solves one problem with several methods; rows to the table, flat pictures and views of the surface to the figure.
struct Comparison {
    Output& output;
    Figure& figure;
    std::string name;  ///< of the pictures
    const bench::Problem& problem;
    BoundaryCondition boundary;
    double azimuth = 30, elevation = 30;
    int squares = 20;
    double max_mu = 1;
    std::string pattern = "polar";  ///< of the checkerboard of planar sources

    std::vector<Solved> run(const std::vector<std::string>& methods);
};

/// A figure by its short name.
struct Entry {
    std::string name;
    Figure (*make)(Output&);
};
/// A page of the documentation and its figures in their order.
struct Page {
    std::string file;          ///< in the folder of the documentation
    std::string introduction;  ///< what comes before the first figure, Markdown
    std::vector<Entry> figures;
};
/// All pages; names of figures are unique among them.
const std::vector<Page>& pages();

Figure figure_01(Output& output);  ///< what μ means, and Teichmüller maps as compositions (Figs 1 and 4)
Figure figure_02(Output& output);  ///< homotopy classes
Figure figure_03(Output& output);  ///< a map that is extremal and not of Teichmüller type
Figure figure_05(Output& output);  ///< trajectories at a zero and at a pole
Figure figure_06(Output& output);  ///< |μ| of discrete conformal maps
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
Figure figure_18(Output& output);  ///< combined with the metric of an ARAP map
Figure figure_19(Output& output);  ///< a ball with twelve holes

// Beyond the paper.
Figure corners(Output& output);    ///< corners of the source and of the boundary values
Figure scan(Output& output);       ///< mcqc3d_planar_src.obj with its pins, if the folder BELTRAMI_MESHES has it
Figure holes_27(Output& output);   ///< 27 holes
Figure smoothing(Output& output);  ///< the QC iteration by passes of smoothing

// Boundaries that slide: beside Ng, Gu & Lui.
Figure sliding_given(Output& output);           ///< given boundary values and the extremal ones (their Figs 1 to 3)
Figure sliding_01(Output& output);              ///< maps with a given coefficient (Examples 1 to 3)
Figure sliding_values(Output& output);          ///< known values of k
Figure sliding_04(Output& output);              ///< their Example 4
Figure sliding_05(Output& output);              ///< orders of convergence
Figure sliding_06(Output& output);              ///< five and nine holes (Examples 6 and 7)
Figure sliding_08(Output& output);              ///< arbitrary shapes and sizes (Examples 8, 10 and 11)
Figure sliding_09(Output& output);              ///< seconds (Example 9)
Figure sliding_12(Output& output);              ///< scans (Example 12), if the folder BELTRAMI_MESHES has them
Figure sliding_13(Output& output);              ///< grids (Example 13), likewise
Figure sliding_mixed(Output& output);           ///< conditions that mix
Figure sliding_classes(Output& output);         ///< holes that change places; rotated starts; symmetric domains
Figure sliding_distance(Output& output);        ///< distances of shapes and their clusters
Figure sliding_distance_scans(Output& output);  ///< of scans, if the folder BELTRAMI_MESHES has them

Figure spheres(Output& output);        ///< closed surfaces, scans if the folder BELTRAMI_MESHES has them
Figure registrations(Output& output);  ///< closed surfaces carried onto each other with landmarks
Figure transfers(Output& output);      ///< a texture, a polyline, points and values, from one to another
Figure tori(Output& output);           ///< flat metrics of tori and the maps between them
Figure genus(Output& output);          ///< exact maps of square-tiled surfaces, deformed double tori

// Along surfaces in space: beside Wong & Zhao.
Figure flow_disk(Output& output);       ///< Table 5.1
Figure flow_sphere(Output& output);     ///< Table 5.2
Figure flow_unfolding(Output& output);  ///< overlapping starts
Figure flow_annulus(Output& output);    ///< a ring of the wrong module
Figure flow_curves(Output& output);     ///< curves that go to curves
Figure flow_square(Output& output);     ///< Table 5.3
Figure flow_tori(Output& output);       ///< least Lᵖ norm

// Into space: beside Gruber & Aulisa.
Figure space_01(Output& output);     ///< genus 2, if the folder BELTRAMI_MESHES has it
Figure space_02(Output& output);     ///< a square with a corner pushed in (with Fig. 16)
Figure space_05(Output& output);     ///< ideal structures embedded, likewise
Figure space_06(Output& output);     ///< cylinders (with Fig. 8)
Figure space_09(Output& output);     ///< a torus with a hole (with Figs 12 and 15)
Figure space_10(Output& output);     ///< a torus with 19 holes (with Fig. 19), likewise
Figure space_14(Output& output);     ///< a sphere with six holes
Figure space_17(Output& output);     ///< two references, likewise
Figure space_18(Output& output);     ///< a part with sharp edges
Figure space_20(Output& output);     ///< a double torus
Figure space_steps(Output& output);  ///< line search and passes of smoothing

}  // namespace beltrami::gallery
