#pragma once

#include <array>

#include "gallery/gallery.h"

/// What the figures of sliding boundaries share.
namespace beltrami::gallery {

/// x, y, radius.
using Hole = std::array<double, 3>;

/// The unit disk with round holes: edge length @p h, 0.4 h at the holes, which have at least so many vertices each.
Mesh disk_with_holes(const std::vector<Hole>& holes, double h, int least_vertices = 30);
TargetDomain circles_target(const std::vector<Hole>& holes);
/// A mesh of any target domain: edge length @p h, @p hole_h at the holes.
Mesh domain_mesh(const TargetDomain& domain, double h, double hole_h);
/// A closed spline through @p points places r(t) e^{it} around a centre.
TargetCurve polar_spline(Complex centre, const std::function<double(double)>& radius, int points = 64);
/// Loops keep their numbers.
Correspondence numbered(std::size_t holes);

/// A map whose boundary slides, or why there is none.
struct SolvedOnto {
    std::optional<ExtremalMap> all;
    double seconds = 0;
    std::string refusal;

    explicit operator bool() const { return all.has_value(); }
    /// The mesh that was mapped.
    const Mesh& mesh(const Surface& source) const { return all->split ? all->split->mesh : source.mesh; }
};
SolvedOnto solve_onto(const Surface& source, const Constraints& onto, const ExtremalOptions& options = {});
/// Any other way to such a map.
SolvedOnto solve_onto(const std::function<ExtremalMap()>& solver);

/// Writes mesh, map and |μ|; returns the file's name.
std::string write(Output& output, const std::string& name, const Surface& source, const SolvedOnto& solved);

/// Head and cells of tables. @p known is what is known about k, with its uncertainty.
std::vector<std::string> onto_head(const std::string& first);
std::vector<std::string> onto_row(const std::string& first, const Surface& source, const std::string& known,
                                  const SolvedOnto& solved);

/// Where every loop's vertices lie, as parts of the arc length from the first one on: of the loop and of its curve.
std::vector<Curve> correspondences(const Surface& source, const TargetDomain& target, const ExtremalMap& map);

/// A planar source and its target: solves, adds a row to @p table and a picture (circles on source and image, |μ|,
/// histogram, boundary correspondence) to the figure.
struct OntoExample {
    std::string name;  ///< of picture and row
    std::string caption;
    int circles = 26;  ///< to the larger side
    std::string known = "";
    std::vector<std::pair<Complex, Complex>> segments = {};

    SolvedOnto run(Output& output, Figure& figure, Table& table, const Surface& source, const TargetDomain& target,
                   const Correspondence& wanted = {}) const;
};

/// Largest |μ| and its 99th percentile, 1 where faces are flipped, of the maps after some iterations.
struct Energies {
    Curve largest, p99;
    int settled = 0;  ///< iterations after which all had settled; 0: never
};
/// From the start that options give, on the source's own mesh; what the iterations so far have reached, one by one.
Energies energies(const std::string& label, const Surface& source, const Constraints& onto,
                  ExtremalOptions options = {});

/// The path of a mesh in the folder BELTRAMI_MESHES; nothing, with a message, if it is not there.
std::optional<std::filesystem::path> scan_path(const std::string& file);

}  // namespace beltrami::gallery
