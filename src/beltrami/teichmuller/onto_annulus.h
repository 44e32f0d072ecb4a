#pragma once

#include <optional>

#include <beltrami/certificate/modulus.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/targets/correspondence.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// The extremal map of a crowded annulus without marks onto a round ring, without an iteration: affine in the
/// logarithms of both, by the surface's two potentials (annulus_map.h). A boundary is crowded where the conformal map
/// takes an edge to less than a thousandth of a mean one, as the walls of a slot: there sliding along the boundary has
/// no energy to go by. K* lies in a bracket from the two capacities, which is rigorous for the polyhedron up to
/// floating point; K is the middle of it.
/// @return nothing where the surface is no such annulus, the target is not between two circles about one centre, marks
///         or a way are given, or faces come out turned over
/// @throw Error not_solved
std::optional<ExtremalMap> crowded_annulus_onto_ring(const Surface& source, const TargetModel& target,
                                                     const Correspondence& wanted);

/// The same of any annulus, crowded or not, onto a round ring, whose circles need not be concentric.
/// @param of_target its modulus where it stands for another surface; null: that of the circles
std::optional<ExtremalMap> annulus_onto_ring(const Surface& source, const TargetModel& target,
                                             const Correspondence& wanted, const ModulusBracket* of_target = nullptr);

}  // namespace beltrami
