#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/space/corner_elements.h>

#include "gallery/gallery.h"

namespace beltrami::gallery {

/// Maps of one surface in space, side by side: rows of a table, surfaces coloured by |μ| and by μ₁, histograms of |μ|
/// and of the angles.
class SpaceFigure {
  public:
    struct View {
        double azimuth, elevation;
        double most_mu;  ///< where colours and the histogram end
    };

    /// @param source   whose shapes, or those of a reference, |μ| is against; kept by reference, as all the rest is
    /// @param elements of it
    SpaceFigure(Output& output, Figure& figure, std::string name, const Mesh& source, const CornerElements& elements,
                const View& view);

    /// A map.
    /// @param normals #V×3 that say what is upright: those of the surface on which the image is
    /// @param drawn   whether it stands in the picture, too
    void add(const std::string& method, const Positions& positions, const Positions& normals, bool drawn = true);
    /// A line of the table that says why there is no map.
    void refuse(const std::string& method, const std::string& reason);

    /// Adds the table.
    void end_table(const std::string& caption);
    /// Adds the picture of |μ| and its histograms.
    void end_picture(const std::string& caption);
    /// Adds a picture of μ₁: its real part in the frame whose real axis is horizontal (in the plane: the x-axis), and
    /// of how much it differs from its neighbours' mean.
    void end_components(const std::string& caption, bool differences);

    const Distortion& last() const { return last_; }

  private:
    struct Drawn {
        std::string title;
        Mesh image;
        Eigen::VectorXd abs_mu, first;
        std::vector<double> angles;  ///< parts of 100 in steps of 10 degrees
    };
    Eigen::VectorXd first_components(const Eigen::VectorXcd& mu) const;

    Output& output_;
    Figure& figure_;
    std::string name_;
    const Mesh& source_;
    const CornerElements& elements_;
    View view_;
    double area_;
    Table table_;
    std::vector<Drawn> drawn_;
    Distortion last_;
};

}  // namespace beltrami::gallery
