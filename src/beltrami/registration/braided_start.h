#pragma once

#include <optional>
#include <span>
#include <vector>

#include <beltrami/constraints/constraints.h>
#include <beltrami/homotopy/arc_words.h>

namespace beltrami {

/// A map in the class that the way of its pins says, and what tells this class.
struct BraidedStart {
    Eigen::VectorXcd map;
    ArcWords arcs;
    std::vector<Complex> middles;  ///< of the target's holes, in the order of the source's loops that go there
    ArcWords::Words words;

    bool same_class(const Eigen::VectorXcd& other) const { return arcs.of(other, middles) == words; }
};

/// Pins inside a surface whose boundary slides, led straight from stop to stop and on to their places. They set out
/// from where the harmonic map has them whose boundary vertices stand as their angles in the source's circle domain put
/// them (places_on_curves).
/// @param constraints onto a domain, with pins inside and perhaps marks
/// @param stops       of every step the places of pins in the order of constraints.prescribed; of those that are not
///                    named the straight way
/// @throw Error bad_boundary, bad_option as mixed_conditions; not_solved where the pins cannot go this way
BraidedStart braided_start(const Surface& source, const Constraints& constraints,
                           std::span<const std::vector<std::optional<Complex>>> stops);

}  // namespace beltrami
