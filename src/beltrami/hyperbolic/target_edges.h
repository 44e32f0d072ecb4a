#pragma once

#include <vector>

#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/marking.h>

namespace beltrami::detail {

/// Walks along the edges of the target: steps with homology classes, and shortest paths.
class TargetEdges {
  public:
    explicit TargetEdges(const EdgeGroup& target);

    int size() const { return target_.homology.size(); }
    MarkedStep nowhere() const { return {{}, Eigen::RowVectorXi::Zero(size())}; }
    MarkedStep along(int h) const {
        const int sign = target_.triangulation.tail(h) < target_.triangulation.head(h) ? 1 : -1;
        return {target_.steps[static_cast<std::size_t>(h)], sign * target_.homology.cochains.row(edges_[h])};
    }
    /// @return −1 if no edge joins the vertices
    int halfedge(int a, int b) const {
        for (const int h : from_[a])
            if (target_.triangulation.head(h) == b) return h;
        return -1;
    }
    /// Along a shortest path of edges.
    MarkedStep between(int a, int b);
    /// The shorter way along the boundary loop on which both lie.
    /// @throw Error bad_option if there is none
    MarkedStep along_boundary(int a, int b);

  private:
    /// Where a vertex lies on the boundary: its loop, its number there, and how long the way to it is.
    struct Place {
        int loop = -1, index = 0;
        double length = 0;
    };
    void place_on_loops();
    void search(int a, int b);

    EdgeGroup target_;
    std::vector<std::vector<int>> from_;
    std::vector<int> edges_;
    std::vector<double> distance_;
    std::vector<int> arrived_by_, touched_;
    std::vector<Place> places_;         ///< empty until asked for
    std::vector<double> loop_lengths_;  ///< likewise
};

}  // namespace beltrami::detail
