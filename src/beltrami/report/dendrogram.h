#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/distance.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Shapes in an order in which every cluster is a run: leaves of the tree from left to right.
std::vector<int> cluster_order(const std::vector<Merge>& merges);

/// A picture of a distance matrix and the tree of its clusters, as SVG: shapes in cluster_order along the rows, cells
/// with their distance and coloured by it, the tree beside them with its scale.
/// @param names beside the rows of distances
std::string render_dendrogram(const std::vector<std::string>& names, const Eigen::MatrixXd& distances,
                              const std::vector<Merge>& merges);

}  // namespace beltrami
