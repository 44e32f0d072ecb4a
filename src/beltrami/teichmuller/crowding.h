#pragma once

#include <vector>

#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

/// Whether the boundary values of a disk crowd in its chart: quadrilaterals of the rim force so much there that
/// polynomials in the chart, which see next to nothing of legs and horns, show little of φ.
/// @param harmonic #V the harmonic map with the boundary values
bool values_crowd(const Surface& source, const Chart& chart, const Eigen::VectorXcd& harmonic);

/// What stands for the chart of such a disk in the c-step: the area of the surface itself, and for places those of the
/// harmonic map, where nothing is crowded, in the frame that these have. Vertices stay where the chart has them.
Chart uncrowded(const Surface& source, Chart chart, const Eigen::VectorXcd& harmonic);

/// Where the c-step holds |μ| of maps of such disks, 0.95 to 0.99: at what has four times the K that quadrilaterals
/// force. Held higher, single faces at jagged corners keep φ from settling.
double crowded_clip(const Surface& source, const Chart& chart, const Eigen::VectorXcd& harmonic);

/// The fewest clusters of samples that resolve φ there.
inline constexpr int kCrowdedClusters = 8'000;

/// A node on the rim of a disk, and its way along the image of the rim as an angle.
struct RimNode {
    int node;
    double way;
};
/// The vertices of the rim; none where the image has no length.
std::vector<RimNode> rim_nodes(const Surface& source, const Eigen::VectorXcd& map);

/// Products of the one-forms ∂F_j and conj(∂̄F_j) of the harmonic functions F_j with the boundary values e^{ijt}, where
/// t is the way along the image of the boundary, j = 1, …, 6: holomorphic as far as the elements are harmonic, and of
/// the size that φ has in every leg, whatever its share of the chart. Orthonormal in L² of the surface, without those
/// that all but depend on others; known at the samples.
/// @param operators of any elements
/// @param rim       all of their nodes on the rim
/// @param solver    of these operators, factorised for the coefficient 0, with the whole rim fixed
TabulatedSpace form_product_space(const Operators& operators, const std::vector<RimNode>& rim,
                                  const BeltramiSolver& solver);

}  // namespace beltrami
