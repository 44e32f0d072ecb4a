#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/distance.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The extremal map between two tori in a class of maps: affine between their flat metrics.
///
/// The base's map has the images of the vertices in the flat coordinate of the target, lifted as FlatTorus::lattice of
/// the source; its distortion is that of the source's own faces onto the flat target, whose error falls with the length
/// of the edges, while K and mu are those of the affine map.
struct TorusMap : MapResult, CarriedSurface {
    double K = 1, k = 0;
    /// For the two polyhedra K* of the class lies between these, up to rounding (FlatTorus::tau_error).
    double K_lower = 1, K_upper = 1;
    Complex mu;            ///< constant, in the flat coordinate of the source; φ is conj(mu) dz², up to a factor > 0
    TorusMarking marking;  ///< where the generators of the source go, in those of the target
    Complex target_tau;    ///< of the target in the images of the source's generators
};

/// What a map between tori is asked for.
struct TorusMapOptions {
    /// Nothing: the one of the shortest distance of all (nearest_marking).
    std::optional<TorusMarking> marking;
    /// The vertex of the source and the one of the target it goes to: extremal maps differ by translations. −1: the
    /// first corner of the first face.
    std::array<int, 2> vertices{-1, -1};
};

/// K = exp(d), d the hyperbolic distance of τ of the source and that of the target in the marking: Teichmüller's
/// theorem for genus 1 (Grötzsch's problem on the torus). μ = −(τ₂ − τ₁)/(τ₂ − conj τ₁).
/// @throw Error bad_option unless the marking has determinant 1 and the vertices exist and have faces; as flat_torus
TorusMap torus_map(const Surface& source, const Surface& target, const TorusMapOptions& options = {});

/// The same from flat metrics at hand.
TorusMap torus_map(const Surface& source, const FlatTorus& flat_source, const Surface& target,
                   const FlatTorus& flat_target, const TorusMapOptions& options = {});

/// All distances of some tori, each the least over all markings, with a bracket that holds for the polyhedra up to
/// rounding.
struct TorusDistances {
    DistanceMatrix matrix;
    std::vector<Complex> tau;  ///< of every torus, reduced
    struct Pair {
        int from, to;
        TorusMarking marking;
    };
    std::vector<Pair> markings;  ///< of the pairs from < to, in their order
};

/// @param names what errors call the shapes; empty: "shape 0" …
/// @throw Error bad_option for fewer than two; as flat_torus, naming the shape
TorusDistances torus_distances(const std::vector<Surface>& surfaces, const std::vector<std::string>& names = {});

}  // namespace beltrami
