#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/registration/alignment.h>
#include <beltrami/teichmuller/class_search.h>
#include <beltrami/teichmuller/hyperbolic_map.h>
#include <beltrami/teichmuller/torus_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How the class of maps between two surfaces with handles is chosen.
struct HandleMarking {
    /// Sought among all, before the twists, where nothing tells it (class_search.h): of closed surfaces of genus 2 or
    /// more.
    std::optional<ClassSearchOptions> search = {};
    /// By nearest points after this alignment, unless one of the following is given.
    Alignment alignment = Alignment::none;
    /// #V points near which the source's vertices are to go, near the target.
    std::optional<Positions> start = {};
    /// 2g closed paths of vertices of the source through one vertex, and their images (marking_by_loops).
    std::vector<std::vector<int>> paths = {}, images = {};
    /// Dehn twists about simple closed paths of vertices of the source, one after the other.
    struct Twist {
        std::vector<int> path;
        int turns = 1;
    };
    std::vector<Twist> twists = {};
};

/// The extremal map of a surface with a metric of curvature −1 onto another one.
struct HandleRegistration {
    HyperbolicMap map;
    std::optional<ClassSearch> search;  ///< where the class was sought; its map was taken
    int mended = 0;                     ///< faces around which nearest points did not close up (Marking::mended)
    /// k of the extremal map back in the inverse class, from the target's own mesh and differentials: how far k is from
    /// it is an estimate of the meshes' error. Empty where that class was not found from the places.
    std::optional<double> inverse_k;
};

/// @throw Error as hyperbolic_map and search_class, marking_by_vertices, marking_by_loops, twisted; bad_option where
/// the
///        class is told in two ways
HandleRegistration register_handles(const HyperbolicShape& source, const HyperbolicShape& target,
                                    const HandleMarking& marking = {}, const HyperbolicMapOptions& options = {});

/// The extremal map between two tori in the class that the marking tells; nothing: the one of least dilatation.
/// The first vertex of the source goes to the vertex that the marking sends it to.
/// @throw Error as torus_map and marking_by_vertices
TorusMap register_tori(const Surface& source, const Surface& target, const std::optional<HandleMarking>& marking = {});

/// All distances of surfaces of one topology with metrics of curvature −1, each in the class of nearest points after an
/// alignment, by the extremal maps both ways; where nearest points contradict each other, in the class of maps over a
/// third shape.
/// @param search   instead of all that, classes are sought for every pair (class_search.h)
/// @param progress called after each pair with their number; returning false cancels (Error cancelled)
/// @param names    what errors call the shapes; empty: "shape 0" …
/// @throw Error as hyperbolic_map, naming the pair
DistanceMatrix handle_distances(const std::vector<Surface>& surfaces, Alignment alignment = Alignment::none,
                                const std::function<bool(int done, int all)>& progress = {},
                                const std::vector<std::string>& names = {},
                                const std::optional<ClassSearchOptions>& search = {});

}  // namespace beltrami
