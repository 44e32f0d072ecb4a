#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/forms/harmonic_basis.h>
#include <beltrami/operators/surface.h>
#include <beltrami/uniformize/edge_flips.h>
#include <beltrami/uniformize/triangle_metric.h>

namespace beltrami::detail {

/// Harmonic forms where they are computed: on the intrinsic Delaunay triangulation of a surface.
struct DelaunayForms {
    TriangleMetric metric;                 ///< the surface in triangles, before the flips
    IntrinsicTriangulation triangulation;  ///< after them
    std::vector<EdgeFlip> flips;
    Eigen::MatrixXd cochains;    ///< #halfedges×#loops, integers: the closed forms of the basis, after the flips
    Eigen::MatrixXd potentials;  ///< #V×#loops: with their differences the forms are harmonic
    Eigen::MatrixXd energies;    ///< #loops×#loops

    /// @throw Error as triangle_metric; not_solved
    DelaunayForms(const Surface& surface, const HomologyBasis& basis);

    /// The harmonic forms along a half-edge.
    Eigen::RowVectorXd along(int h) const {
        return cochains.row(h) + potentials.row(triangulation.head(h)) - potentials.row(triangulation.tail(h));
    }

  private:
    void solve();
    void measure();
};

/// The same on the edges of the surface itself.
HarmonicBasis basis_of(const Surface& surface, HomologyBasis homology, const DelaunayForms& found);

}  // namespace beltrami::detail
