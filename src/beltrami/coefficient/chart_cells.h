#pragma once

#include <beltrami/differentials/chart_grid.h>

namespace beltrami {

/// Quadrature over cells of the canonical domain, for functions that are smooth in a cell against weights that differ
/// from sample to sample: what an integral costs then depends on the cells and not on the mesh, but for one pass over
/// the samples that gathers the weights. Cells are small near the unit circle. Samples of a cell that has few of them
/// stand for themselves.
///
/// Linear integrals: the moments of the weights up to the third against the cubic through four places of a circle.
/// Integrals of |φ|: three nodes, fixed, of the mean and covariance of the cell's area, with weights that have the mass
/// and the mean of the given ones; these stay positive, so that Σ w|φ| is convex in φ.
class ChartCells {
  public:
    /// @param areas #S in the canonical domain
    /// @param phase rotation of the cells and their nodes, tied to the data so that turning the source changes nothing
    ChartCells(const Chart& chart, const Eigen::VectorXd& areas, double phase);

    int cell_count() const { return grid_.cell_count(); }

    /// Places in the canonical domain for integrals of |φ|.
    const Eigen::VectorXcd& nodes() const { return nodes_; }
    /// Weights of the nodes for weights of the samples (#S, not negative).
    Eigen::VectorXd node_weights(const Eigen::VectorXd& of_samples) const;

    /// Places for linear integrals.
    const Eigen::VectorXcd& places() const { return places_; }
    /// Weights of the places for weights of the samples (#S).
    Eigen::VectorXcd place_weights(const Eigen::VectorXcd& of_samples) const;

  private:
    struct Cell {
        Complex centre;     ///< mean of its area
        int node, place;    ///< the first of its own
        bool itself;        ///< its samples stand for themselves
        double xx, xy, yy;  ///< the inverse of C^½, C the covariance of its area
        Complex direction;  ///< of the first node before C^½, of length √2
    };
    void set_nodes(Cell& cell, const Eigen::VectorXd& areas, int index);

    const Chart& chart_;
    double phase_;
    ChartGrid grid_;
    std::vector<Cell> cells_;
    Eigen::VectorXcd nodes_, places_;
};

}  // namespace beltrami
