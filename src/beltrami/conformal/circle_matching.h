#pragma once

#include <span>
#include <vector>

#include <beltrami/conformal/circle_domain.h>

namespace beltrami {

enum class MatchBy {
    position,  ///< nearest after the best rotation
    size,      ///< the largest to the largest, and so on
};

struct CircleMatchingOptions {
    MatchBy by = MatchBy::position;
    bool rotate = true;  ///< false: the source stays as it is turned
};

/// A one-to-one correspondence of the holes of two circle domains.
struct CircleMatching {
    std::vector<int> partner;  ///< of every source hole, the index of a target hole
    double rotation = 0;       ///< α: the source is turned by e^{iα}, −π < α ≤ π
    double distance = 0;       ///< root mean square of |e^{iα} c − c′| over the pairs
};

/// The correspondence π and rotation α that minimise Σ |e^{iα} c_i − c′_π(i)|²; of equal ones that with the more alike
/// radii, then the smallest |α|. Exact for up to eight holes; for more, the best of the assignments (Kuhn 1955,
/// "Hungarian") from the rotations that bring one of the four outermost source holes in line with a target hole, each
/// improved alternately. By size, only α is chosen by position.
/// @throw Error bad_boundary if the numbers differ
CircleMatching match_circle_domains(std::span<const RoundHole> source, std::span<const RoundHole> target,
                                    const CircleMatchingOptions& options = {});

}  // namespace beltrami
