#pragma once

#include <vector>

#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/marking.h>

namespace beltrami {

/// A class of maps between closed surfaces of one genus that share nothing: both are cut open, the words of their
/// boundaries are brought to the normal form ∏ [a_i, b_i] by cutting and pasting (Brahana 1921), and canonical
/// generators go to canonical generators. Another pair of roots gives another class; all are far from any that one
/// would want.
/// @param source of triangles, @param triangulation of it
/// @param source_lengths, target_lengths #halfedges, infinite where no path is to go
/// @return all vertices at the root of the target; the defect says how much of the words rounding has left
Marking marking_by_cutting(const Surface& source, const IntrinsicTriangulation& triangulation,
                           const std::vector<double>& source_lengths, int source_root, const EdgeGroup& target,
                           const std::vector<double>& target_lengths, int target_root);

}  // namespace beltrami
