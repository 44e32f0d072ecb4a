#pragma once

#include <array>
#include <vector>

#include <beltrami/teichmuller/extremal_sphere.h>

namespace beltrami::bench {

/// A sphere with landmarks whose extremal map has a known k.
struct SphereLandmarks {
    Mesh mesh;  ///< its positions are the map to the sphere
    std::vector<SphereLandmark> landmarks;
    double exact_k = 0;
};

/// Four points of an octahedral sphere (8·4^levels triangles) in general position, moved by some amplitude. K is that
/// of the affine map between the tori that cover the sphere with branch points there: the distance of their τ, from
/// elliptic integrals, followed along the landmarks' way.
SphereLandmarks four_landmarks(int levels, double amplitude);

/// Radii of two rings of four points, {r i^j} and {s e^{iα} i^j}, in the plane of the stereographic projection.
struct TwoRings {
    double r, s, alpha;
};

/// Eight points, the two rings, moved to two others: under z ↦ z⁴ the problem is that of 0, ∞, r⁴ and s⁴ e^{4iα}, as
/// simple poles at branch points become zeros.
SphereLandmarks eight_landmarks(int levels, const TwoRings& from, const TwoRings& to);

}  // namespace beltrami::bench
