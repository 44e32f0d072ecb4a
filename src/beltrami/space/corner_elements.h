#pragma once

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/operators/operators.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The elements on which maps of surfaces into space are measured and solved for. A polygon is its corner triangles
/// (corner, next, previous), in one fixed frame: a triangle is one sample, an n-gon has n of 1/(4 sin²(π/n)) of their
/// areas each, for a quad one half. For planar bilinear quads this is the trapezoid rule: there is no hourglass mode,
/// affine maps are exact, and the element folds nowhere exactly if no corner does.
///
/// The frame's real axis is Σ x_j p_j, x_j those of the regular n-gon whose first edge is horizontal, projected to the
/// plane of every corner triangle: of a triangle its first edge, of a quad ∂X/∂ξ at its centre. A coefficient of an
/// element is one number in this frame; a planar mesh takes the plane's own x + iy.
struct CornerElements {
    Operators operators;              ///< samples: the corner triangles of face after face
    Eigen::VectorXcd edge_direction;  ///< #corners: of the edge to the next corner, in the element's frame, of length 1
};

/// Elements of a mesh by its own shape.
/// @pre every polygon has three corners or more
/// @throw Error bad_mesh naming faces with a corner triangle that has no area or is turned over
CornerElements corner_elements(const Mesh& mesh);

/// The same of the metric in which every face has the shape of its points in @p corners (#corners×2 or ×3).
CornerElements corner_elements(const Mesh& mesh, const Positions& corners);

/// Unit normals of the corner triangles of a mesh in space, one row a sample of corner_elements (#S×3); zero where a
/// triangle has no area.
Positions corner_normals(const Mesh& mesh);

/// One value for every face as area-weighted mean of its samples' (#F from #S).
Eigen::VectorXcd face_means(const Operators& operators, const Eigen::VectorXcd& samples);

/// One value a face at its samples (#S from #F).
Eigen::VectorXcd face_values_at_samples(const Operators& operators, const Eigen::VectorXcd& faces);

}  // namespace beltrami
