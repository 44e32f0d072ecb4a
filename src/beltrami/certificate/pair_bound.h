#pragma once

#include <array>
#include <optional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh of the image of a surface whose boundary is the image of the surface's boundary. Its inside need not have to
/// do with the surface.
struct BoundaryImage {
    /// A vertex on the boundary: the image of the place (1 − t) from + t to on a boundary edge of the surface.
    struct Place {
        int vertex, from, to;
        double t;
    };
    Operators operators;
    std::vector<std::vector<Place>> loops;  ///< in the direction of topology.boundary_loops
    bool same_faces = false;  ///< faces and vertices are those of the surface, moved by a map of its class
};

/// The image under a piecewise linear map.
/// @pre all faces are triangles
/// @return nothing if the map turns a face over or collapses it
std::optional<BoundaryImage> image_under(const Surface& source, const Eigen::VectorXcd& map);

/// A triangulation of its own of the polygon that the boundary of a disk goes to, about a quarter as fine as the disk.
/// @param map #V of which the boundary counts
/// @return nothing if the polygon is not simple and counter-clockwise, or cannot be triangulated
std::optional<BoundaryImage> filled_image(const Surface& source, const Eigen::VectorXcd& map);

struct PairBoundOptions {
    int most_steps = 40;      ///< of Lanczos' iteration, two solves each, at least 1
    double tolerance = 1e-5;  ///< it ends where the bound grows by less than this part in three steps
};

/// A pair of piecewise linear functions, and what it proves.
struct PairBound {
    double K = 1;          ///< K* ≥ this
    Eigen::VectorXd u, v;  ///< #V of the image and of the source
    int factorizations = 0, steps = 0;
};

/// The bound of one quadrilateral: K* is at least the ratio of the moduli of the surface and of its image, between
/// corners at four positions of the boundary loop (modulus.h). Every such bound is one of a pair, so pair_bound() with
/// the same image is no smaller; this costs four factorisations and no iteration. The image is that of the polygon
/// itself: where it is inscribed in a circle, its chords count.
/// @param positions ascending
/// @pre a disk of triangles
double quadrilateral_bound(const Surface& source, const BoundaryImage& image, const std::array<int, 4>& positions);

/// The largest bound that pairs of piecewise linear functions prove: for u on the image T and v on the surface S, both
/// linear on triangles, every quasiconformal f: S → T with the boundary values b satisfies
///
///     ∫_∂S (u∘b) dv = ∫_S d(u∘f) ∧ dv ≤ (D_S(u∘f) D_S(v))^½ ≤ (K D_T(u) D_S(v))^½,   D = ∫|∇|²,
///
/// so K ≥ (∫ (u∘b) dv)² / (D_T(u) D_S(v)): no chart, no differential, and cone points do no harm. Only the boundary
/// values enter, hence on a surface with holes the bound holds for every homotopy class. The best pair has the largest
/// eigenvalue of Wᵀ L_T⁻¹ W v = λ L_S v. Two factorisations and two solves a step. The bound is evaluated anew at the
/// end, so that it is a proof up to rounding however far the iteration has come.
///
/// With @p branches u and v are functions up to sign that change it around these vertices. If every map of the class
/// takes them to the same places (pins), it lifts to the double covers, and the same proof holds.
///
/// As a square (du + i dv)² without zeros of odd order the pair says less where the extremal φ has such.
/// @param branches inner vertices of a disk whose images are prescribed; only with an image of the same faces
/// @pre all faces of source are triangles
/// @throw Error not_solved
PairBound pair_bound(const Surface& source, const BoundaryImage& image, const std::vector<int>& branches = {},
                     const PairBoundOptions& options = {});

/// The same for functions up to sign that change it around some holes: every map lifts to the double covers that
/// belong to them, as its homotopy class says.
/// @param image of the same faces, under a map of the class
/// @param signs beside operators.vertices, of functions of which no constant is one
PairBound pair_bound_up_to_sign(const Surface& source, const BoundaryImage& image,
                                const std::vector<signed char>& signs, const PairBoundOptions& options = {});

}  // namespace beltrami
