#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/teichmuller/extremal_mixed.h>

/// Problems with mixed boundary conditions, for benchmarks and tests: data only, nothing is solved here. Each comes
/// with its inverse (@p back): a map and its inverse have the same k.
namespace beltrami::bench {

struct MixedProblemCase {
    std::string name;
    Mesh mesh;
    MixedConditions conditions;
    std::optional<double> exact_k = {};          ///< of the continuous problem
    std::optional<Eigen::VectorXcd> exact = {};  ///< #V the extremal map of the continuous problem
};

/// The ring .5 < |z| < 1, its outer circle prescribed by exp(2 Re w + i Im w), w = log z + .2(2z − 1/(2z)), the inner
/// one sliding to |z| = 1/4: K = 2.
MixedProblemCase sliding_inner_circle(double edge_length, bool back = false);

/// The disk less two round holes, which slide onto two others; the outer circle is prescribed by t + .4 sin(t + .5).
/// @param pinned an inner point is pinned as well
MixedProblemCase two_sliding_holes(double edge_length, bool back, bool pinned);

/// The disk, whose boundary slides, with 2, 3 or 5 inner points pinned elsewhere. k is known for two (Grötzsch's ring).
MixedProblemCase pins_in_sliding_disk(double edge_length, int pins, bool back);

/// The unit square under 2 Re w + i Im w, w = z + .04/π sinh πz: left and right sides prescribed, the others slide: K
/// = 2.
MixedProblemCase two_sliding_sides(double edge_length, bool back = false);

/// The disk, its upper half circle sliding along a segment, the lower one prescribed; in the coordinate t that takes
/// the upper one to the diameter of a half disk it is 2 Re w + i Im w, w = t + .2 t², opened by a sine: K = 2.
MixedProblemCase sliding_half_circle(double edge_length, bool back = false);

/// The disk, prescribed by t + .3 sin(t + .4) on the arcs [.3, 1.5] and [2.5, 4.4], sliding elsewhere.
MixedProblemCase two_prescribed_arcs(double edge_length, bool back, bool pinned);

/// A scanned face: its outline, mesh loop 0, prescribed by arc length around the circle from the angle .5 on, the other
/// loops slide onto the circles of its own circle domain, turned as the outline is. Back, from a mesh of that image, to
/// the circle domain: conformal maps change no k.
MixedProblemCase sliding_holes_of_face(const Mesh& face, double edge_length, bool back = false);

}  // namespace beltrami::bench
