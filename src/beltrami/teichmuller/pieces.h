#pragma once

#include <string>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// A part of a surface whose boundary is prescribed: a problem of its own.
struct ProblemPiece {
    Surface surface;
    BoundaryCondition boundary;
    int outer_loop;             ///< the loop whose image surrounds the others'
    std::vector<int> vertices;  ///< of the whole, ascending
    std::vector<int> faces;     ///< of the whole, ascending
    std::vector<int> pins;      ///< beside boundary.vertices: place in the whole's boundary.vertices
    std::vector<int> samples;   ///< of the whole
};

struct ProblemPieces {
    std::vector<ProblemPiece> pieces;  ///< by their first face; empty where nothing is cut
    std::string obstacle;              ///< why the surface is not cut although pinned curves would; else empty
};

/// The pieces into which curves of pinned vertices cut a surface. Nothing passes from one to the other: the maps with
/// these constraints are those of the pieces, put together, and K* is the largest of theirs. Curves that end inside
/// stay in their piece.
/// @pre validate(boundary, source); one component of genus 0, its boundary prescribed
ProblemPieces pieces_of(const Surface& source, const BoundaryCondition& boundary);

}  // namespace beltrami
