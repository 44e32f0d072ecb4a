#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/operators/distortion.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How an iteration ended.
enum class Termination {
    converged,        ///< what it settles has settled
    iteration_limit,  ///< max_iterations
    /// Settled, but at a boundary vertex the boundary values alone force a larger dilatation than the K found: the
    /// extremal map is not of Teichmüller type and not unique.
    not_teichmuller,
    /// Settled, but what is proved about K* is larger than the K found: the differentials at hand cannot show the
    /// extremal φ. K is then the proved bound.
    below_bound,
    /// Settled, but nothing confirms the map: faces are flipped, or K is far above every lower bound that is known.
    unconfirmed,
};
const char* to_string(Termination);

/// What every map of this library comes with.
struct MapResult {
    Eigen::VectorXcd map;   ///< #V images in the plane
    Distortion distortion;  ///< of map
    Termination termination = Termination::converged;
    int iterations = 0;      ///< linear solves
    int factorizations = 0;  ///< of #V×#V systems and larger, those of charts and starts included
    Warnings warnings;

    /// Whether no face is flipped or collapsed: with a simple boundary polygon the map is then one-to-one.
    bool one_to_one() const { return distortion.flipped.empty() && distortion.degenerate.empty(); }
};

/// Adds warnings about flipped faces, with what follows from them (@p further), and, after a limit, about @p stopped:
/// "7 iterations before the map settled".
void warn_of_folds_and_limit(const std::string& stopped, MapResult& result, const char* further = "");

}  // namespace beltrami
