#pragma once

#include <beltrami/base/public.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/operators/map_derivatives.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A statement about a dilatation K.
struct Bound {
    enum class Kind {
        reich_strebel,           ///< 1/I⁻ of a map and a φ
        reich_strebel_estimate,  ///< √(I⁺/I⁻)
        reich_strebel_upper,     ///< I⁺, where boundaries slide
        averaged_estimate,       ///< of the coefficient averaged over vertex stars
        corner,                  ///< of smooth data with this corner
        edge_corner,             ///< edge_corner_bound.h
        moduli,                  ///< modulus.h
        moduli_upper,            ///< modulus.h from above, where boundaries slide
        pair,                    ///< pair_bound.h
        verified,                ///< an upper bound by a map that was verified
        mesh_harmonic,           ///< mesh_harmonic_bound()
        attained,                ///< the largest K of a face
    };
    enum class Of {
        extremal,  ///< K*, the dilatation of the extremal map
        mesh,      ///< every piecewise linear map of this mesh
        /// Every map of exactly these polygons with values linear on their edges; K* of a smooth outline and smooth
        /// values that they are sampled from may be smaller.
        polygons,
    };
    Kind kind;
    double K;
    Of of;
    bool rigorous;  ///< a proof up to floating point and quadrature; else an estimate

    /// Whether it proves K* ≥ K.
    bool proves_from_below() const;
};
const char* to_string(Bound::Kind kind);  ///< its name in records
const char* to_string(Bound::Of of);

/// Integrals of a map's coefficient μ against a holomorphic φ, and what follows from them:
/// I∓ = ∫|φ| |1 ∓ μφ/|φ||²/(1−|μ|²) / ∫|φ|  (Reich & Strebel).
struct ReichStrebel {
    double lower = 0;  ///< 1/I⁻ ≤ K* for every quasiconformal f in the class and holomorphic φ
    double estimate = 0;  ///< √(I⁺/I⁻) = (1+k)/(1−k) with S of the c-step; lower ≤ estimate ≤ K of the worst face
    double upper = 0;    ///< I⁺, which K* approaches from below at the extremal φ
    bool valid = false;  ///< false where the map has |μ| ≥ 1 somewhere, or φ or μ is not finite
    /// The quadrature has resolved the singularities of φ. Never so for a tabulated φ, which is not known to be
    /// holomorphic: all numbers are then estimates, no bounds.
    bool resolved = false;
};

/// The same from the integrals ∫|φ|, ∫|φ|(1+|μ|²)/(1−|μ|²) and 2 Re ∫μφ/(1−|μ|²).
/// @param unresolved part of ∫|φ| of which the quadrature is not sure
ReichStrebel reich_strebel_of(double total, double norm, double pairing, double unresolved);

/// The Reich-Strebel integrals of any map and any φ, by adaptive quadrature (differential_quadrature.h), or at one
/// point a sample where φ is tabulated; μ is constant on a sample, which has its quarter of a quad. Samples that φ's
/// chart excludes take no part. φ may have any scale and zero() says K ≥ 1; 1/I⁻ is largest where μ = k conj(φ)/|φ|.
///
/// `lower` is a bound of K* in the class of the map, up to floating point and quadrature, where all of this holds:
/// - φ is admissible: integrable, with simple poles where images are prescribed inside; where the boundary slides, φ τ²
///   is real along it, and has simple poles at marks only;
/// - φ is holomorphic on the very mesh: proves(source, phi), as for φ(z) of one's own on a planar mesh of triangles;
/// - `resolved` is set, which never happens where φ is tabulated.
/// Else it is an estimate, whose error falls with the edges. `estimate` is one of K* for the pair that solves the
/// problem, and for others nothing. Reich & Strebel 1974, in Gardiner & Lakic: Quasiconformal Teichmüller Theory.
/// @param mu #S coefficients of the map in the samples' frames, |μ| < 1 (else not valid)
/// @throw Error bad_option if μ or a tabulated φ does not have #S values
ReichStrebel reich_strebel(const Surface& source, const QuadraticDifferential& phi, const Eigen::VectorXcd& mu);
ReichStrebel reich_strebel(const Surface& source, const QuadraticDifferential& phi, const MapDerivatives& map);

/// The same for a combination of a space that is written down in a chart.
ReichStrebel reich_strebel(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                           const Eigen::VectorXcd& coefficients, const Eigen::VectorXcd& mu);

/// The same integrals of the coefficient averaged over vertex stars (conformal/averaged_coefficient.h) at one point a
/// sample, |μ| held at .995: where K is large `lower` estimates K* within a fraction of a per cent to a few per cent,
/// while k of the faces is far too high. It is a bound of nothing, and its error has either sign.
/// @param phi #S φ in the samples' frames
/// @param map #V
ReichStrebel averaged_estimate(const Surface& source, const Chart& chart, const Eigen::VectorXcd& phi,
                               const Eigen::VectorXcd& map);

/// Whether φ of this chart make Reich-Strebel integrals of a piecewise linear map a proof (up to floating point and
/// quadrature): the chart is holomorphic, and all faces are triangles. On quads μ is taken at the Gauss points only.
bool proves(const Surface& source, const Chart& chart);
bool proves(const Surface& source, const QuadraticDifferential& phi);

/// Every piecewise linear map of this mesh with these boundary values has K ≥ c + √(c²−1), with c the Dirichlet energy
/// of the harmonic map over the area of the image, normalised to 1 for a conformal map.
/// @return 1 where the area of the image is not positive
double mesh_harmonic_bound(const Operators& source, const Eigen::VectorXcd& harmonic);

}  // namespace beltrami
