#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/report/page_differential.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A closed surface with handles cut open and laid out in the plane, as a page draws it.
struct PageDomain {
    Mesh mesh;                ///< cut along the seams of the layout: vertices have copies
    std::vector<int> joined;  ///< of every copy, the vertex of the surface
    Positions layout;         ///< of every copy, its place in the plane
    /// Curves in that plane: a fundamental polygon with straight (geodesic) sides of the area of the surface, and of
    /// genus 2 and more the circle around the disk. The faces, which are not cut, fill it but for its rim.
    std::vector<Positions> outline;

    /// Values of the surface's vertices for the copies.
    Positions at_copies(const Positions& values) const;
    /// The same of the places of zeros and poles.
    PageDifferential at_copies(PageDifferential differential, const Mesh& surface) const;
};

/// A torus over the parallelogram of its generators.
PageDomain page_domain(const Surface& surface, const FlatTorus& torus);

/// A surface with a hyperbolic metric in the unit disk; a closed one with the Dirichlet polygon about the middle
/// (fundamental_polygon.h).
PageDomain page_domain(const Surface& surface, const HyperbolicSurface& metric, const HyperbolicDomain& domain);

/// φ = conj(μ) dz² of an affine map between tori, z the flat coordinate of the source: its directions; no zeros.
PageDifferential page_differential(const Surface& surface, const FlatTorus& torus, Complex mu);

}  // namespace beltrami
