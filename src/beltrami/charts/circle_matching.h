#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/plane/disk_moebius.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A place of one disk, its circle included, that belongs to one of another.
struct PlacePair {
    Complex source, target;
};

struct CircleMatchingOptions {
    MatchBy by = MatchBy::position;
    std::vector<PlacePair> places = {};  ///< marked ones, whose fit counts as well
    /// Holes of the source that are paired already, and of the target with which; no two with the same.
    std::vector<std::array<int, 2>> pairs = {};
};

/// A one-to-one correspondence of the holes of two circle domains.
struct CircleMatching {
    std::vector<int> partner;  ///< of every source hole, the index of a target hole
    DiskMoebius move;          ///< of the source
    double distance = 0;  ///< root mean square of the hyperbolic distances of the moved centres from their partners
};

/// The Möbius map T of the disk with the least Σ sinh²(d(T z, w)/2), d the hyperbolic distance; pairs on the unit
/// circle count |T z − w|²/|T' z|. With T z = (αz + β)/(β̄z + ᾱ) the sum is a quadratic form in (α, β), to be least
/// where |α|² − |β|² = 1: an eigenvalue problem of four unknowns. Of equally good maps that with the least |β|.
/// @return the identity without pairs
DiskMoebius best_move(std::span<const PlacePair> pairs);

/// The same among rotations, least Σ |e^{iα} z − w|².
DiskMoebius best_rotation(std::span<const PlacePair> pairs);

/// The correspondence π and Möbius map T that minimise Σ sinh²(d(T c_i, c′_π(i))/2) + sinh²((ρ_i − ρ′_π(i))/2) over the
/// hyperbolic centres and radii of the holes: it does not depend on where Möbius maps have put either domain. (Centres
/// alone would not do: two holes can always be exchanged, three nearly.) Of equal ones that with the more alike radii,
/// then the one that moves the centre least, then the one of
/// the smallest rotation. Exact for up to eight holes; for more, the best of the assignments (Kuhn 1955, "Hungarian")
/// from the maps that bring two far source holes to two target holes as far from each other, each improved
/// alternately. By size, only T is chosen by position.
/// @throw Error bad_boundary if the numbers differ
CircleMatching match_circle_domains(std::span<const RoundHole> source, std::span<const RoundHole> target,
                                    const CircleMatchingOptions& options = {});

}  // namespace beltrami
