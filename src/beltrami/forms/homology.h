#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Loops that generate the first homology of a surface, and the closed 1-forms that are dual to them. All integers, and
/// exact.
struct HomologyBasis {
    /// Closed paths of vertices along edges, no vertex twice: 2·genus of a closed surface, one more for every boundary
    /// loop but one. In the order of their lengths with the way from the common vertex.
    std::vector<std::vector<int>> loops;
    std::vector<double> lengths;  ///< of the loops, in the metric of the surface
    /// Intersection numbers: +1 where loop j crosses loop i from right to left. Antisymmetric; unimodular if the
    /// surface is closed.
    Eigen::MatrixXi intersections;
    /// #E×#loops: values of closed 1-forms along the edges of the topology, from the smaller vertex to the larger;
    /// around loop i form j adds up to 1 if i = j, else to 0.
    Eigen::MatrixXi cochains;

    int size() const { return static_cast<int>(loops.size()); }
};

/// The shortest loops through the first vertex that has a face (Erickson, Whittlesey 2005, "Greedy optimal homotopy and
/// homology generators"), each without the way to it: a tree of shortest paths along edges, a tree of faces across the
/// other edges of largest loops, and one loop for each edge in neither. Boundary loops count as one more face.
/// Intersections are read off the cyclic order of the loops' ends around the tree.
/// @throw Error bad_mesh unless the surface has one component
HomologyBasis homology_basis(const Surface& surface);

/// The homology class of a closed path in terms of the loops of the basis.
/// @param path vertices, each joined by an edge to the next and the last one to the first
/// @return #loops
/// @throw Error bad_option naming two vertices without an edge
Eigen::VectorXi homology_class(const Topology& topology, const HomologyBasis& basis, std::span<const int> path);

/// A basis in which intersections have their normal form: with the columns a_1 … a_g, b_1 … b_g, and then c of
/// boundary loops, a_i·b_i = 1, b_i·a_i = −1 and all others 0.
/// @param intersections antisymmetric, with elementary divisors 0 and 1 only, as of a surface
/// @return unimodular; columns are sums of the loops
Eigen::MatrixXi symplectic_basis(Eigen::MatrixXi intersections);

}  // namespace beltrami
