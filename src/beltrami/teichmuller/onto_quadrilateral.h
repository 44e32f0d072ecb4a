#pragma once

#include <array>
#include <optional>

#include <beltrami/starts/target_model.h>
#include <beltrami/targets/correspondence.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// A disk whose boundary slides around a curve with four marks.
struct MarkedQuadrilateral {
    std::array<int, 4> positions;      ///< of the marks on the loop, ascending
    std::array<double, 4> parameters;  ///< where they go on the curve
};
/// @return nothing unless the source is a disk with four marks and no way is prescribed
std::optional<MarkedQuadrilateral> marked_quadrilateral(const Surface& source, const Correspondence& wanted);

/// The modulus of the target between four places of its curve, as quadrilateral_modulus() has it: of a circle, and of
/// a rectangle between its corners.
std::optional<double> target_modulus(const TargetDomain& target, const std::array<double, 4>& parameters);

/// The extremal map of a disk with four marks onto a rectangle, corners to corners, without an iteration: affine in the
/// surface's two potentials (modulus.h), each by one linear solve. No chart of the disk is needed, however crowded it
/// is. K* is the ratio of the moduli, in the bracket that the potentials' energies give, rigorous for the polyhedron up
/// to floating point; K is the middle of it.
/// @return nothing where that is not the problem, or faces stay flipped
/// @throw Error not_solved
std::optional<ExtremalMap> quadrilateral_onto_rectangle(const Surface& source, const TargetModel& target,
                                                        const Correspondence& wanted);

}  // namespace beltrami
