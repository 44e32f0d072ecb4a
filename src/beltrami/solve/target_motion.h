#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <beltrami/constraints/target_constraints.h>
#include <beltrami/linear/graph_laplacian.h>

namespace beltrami {

/// How the vertices of a map may move along its target, and where they then are: free ones in the tangent plane and
/// back onto the target, sliding ones along their curve by arc length, held ones not at all. By what a curve bends away
/// from its tangents the vertices around come along: this part of the motion is extended inward harmonically, as else
/// thin faces at the boundary would fold.
class TargetMotion {
  public:
    /// @param source, target, constraints kept by reference
    TargetMotion(const Surface& source, const Target& target, const TargetConstraints& constraints);

    /// Directions of a vertex's two unknowns, of length 1: the second is 0 where a vertex slides, both where it stays.
    using Directions = std::array<Eigen::Vector3d, 2>;
    /// @param across of length 1, what a vertex that is free moves at right angles to: the target's normal there, or
    ///               that of its face
    Directions directions(int vertex, const TargetMap& map, const Eigen::Vector3d& across) const;
    /// 0 to 2 unknowns a vertex.
    const std::vector<signed char>& unknowns() const { return unknowns_; }
    /// #V: the number of a vertex among those that move, −1 elsewhere.
    std::vector<int> indices_of_moving() const;

    /// The map after a motion times a length.
    /// @param motion #V×3, in the directions of the map's vertices
    TargetMap moved(const TargetMap& map, const Positions& motion, double length) const;

    const Target& target() const { return target_; }
    /// Whether nothing is held.
    bool unheld() const { return constraints_.empty(); }

  private:
    const Target& target_;
    const TargetConstraints& constraints_;
    std::vector<signed char> unknowns_;
    std::vector<int> slide_;                  ///< #V of constraints_.sliding, −1 elsewhere
    std::unique_ptr<GraphLaplacian> inward_;  ///< null where nothing slides
};

/// The graph of a mesh, all its edges alike, with vertices held, factorised.
/// @param held #V flags
std::unique_ptr<GraphLaplacian> graph_of(const Surface& source, const std::vector<char>& held);
/// #V×3: given where vertices of the graph are held, harmonic in between.
Positions extended(const GraphLaplacian& graph, const Positions& values);

/// #V×3: the motion that two unknowns a moving vertex are.
/// @param indices TargetMotion::indices_of_moving()
/// @param ways    #V, the directions of these unknowns
Positions motion_along(const std::vector<int>& indices, const std::vector<TargetMotion::Directions>& ways,
                       const Eigen::VectorXd& unknowns);

}  // namespace beltrami
