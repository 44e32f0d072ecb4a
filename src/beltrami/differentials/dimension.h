#pragma once

namespace beltrami {

/// Real dimension of the integrable holomorphic quadratic differentials φ on a planar domain with φ τ² real along its
/// boundary (τ the tangent), which may have simple poles at marked points: those of the sphere, torus or surface of
/// genus `holes` that two copies of the domain make, with the marks as punctures. 3 holes − 3 + marks for two holes or
/// more; an annulus has 1 and gains nothing by its first mark, which only stops it from turning; a disk needs three
/// marks for nothing, and has one for every further one.
/// @param holes          at least 0
/// @param boundary_marks on the boundary
/// @param interior_marks inside; each counts twice
int dimension_of_differentials(int holes, int boundary_marks, int interior_marks = 0);

}  // namespace beltrami
