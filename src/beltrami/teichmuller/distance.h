#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Teichmüller's distance ½ log K* of two shapes of one topology, with its bracket.
struct Distance {
    double distance = 0;  ///< from the estimates of K*
    double lower = 0, upper = 0;
    bool settled = true;  ///< every map has converged and is free of folds
};

/// Distance between two surfaces of genus 0 with as many boundary loops. Of disks it is 0, and of rings without marks
/// half the logarithm of the ratio of their moduli, each between two Dirichlet energies (modulus.h), without a map.
/// Of others by the extremal map of each onto the other, whose boundary slides: the lower bound is the larger of the
/// two, the upper one the smaller. Between matched loops and in the class of straight ways (extremal_map.h): another
/// matching or a braid may be nearer.
/// @param wanted loops, marks and waypoints are those of the map from a to b, and must be absent if both directions
/// are
///                wanted
/// @throw Error as extremal_map
Distance teichmueller_distance(const Surface& a, const Surface& b, const Correspondence& wanted = {},
                               const ExtremalOptions& options = {}, int outer = 0, bool both_ways = true);
/// The same of shapes whose charts are kept.
Distance teichmueller_distance(const Shape& a, const Shape& b, const Correspondence& wanted = {},
                               const ExtremalOptions& options = {}, int outer = 0, bool both_ways = true);

/// All distances of some shapes: symmetric, 0 on the diagonal.
struct DistanceMatrix {
    Eigen::MatrixXd distance, lower, upper;
    std::vector<std::array<int, 2>> unsettled;  ///< pairs some map of which has not converged or has folds
};

/// Every shape is charted once, or its modulus worked out; shapes, then pairs, on all threads side by side. Shapes that
/// are the same mesh have distance 0.
/// @param surfaces at least two, kept by reference during the call
/// @param options  progress in them may be called from several threads at once
/// @param progress called on this thread, from time to time and in the end, with the number of pairs that are done;
///                 returning false cancels (Error cancelled)
/// @param names    what errors call the shapes; empty: "shape 0" …
/// @throw Error bad_mesh naming a shape that is not of genus 0 with a boundary; bad_boundary naming two shapes with
///        different numbers of loops; as extremal_map, naming the pair
DistanceMatrix distance_matrix(const std::vector<Surface>& surfaces, const Correspondence& wanted = {},
                               const ExtremalOptions& options = {},
                               const std::function<bool(int done, int all)>& progress = {},
                               const std::vector<std::string>& names = {});

/// A step of hierarchical clustering: two clusters become one.
struct Merge {
    int a, b;       ///< a < b: shapes 0 … n−1, then n + i for the cluster of step i
    double height;  ///< mean distance between their shapes
    int size;       ///< shapes in the cluster
};

/// Agglomerative clustering by mean distances (average linkage; Sokal & Michener 1958): n − 1 steps for n shapes. Of
/// equal heights the pair of smallest numbers is first.
/// @param distances n×n, symmetric
/// @throw Error bad_option unless the matrix is square, symmetric and finite
std::vector<Merge> cluster_by_distance(const Eigen::MatrixXd& distances);

}  // namespace beltrami
