#pragma once

#include <string>
#include <vector>

#include <beltrami/base/warning.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

struct ProjectionOptions {
    std::vector<int> marked =
        {};  ///< vertices that maps keep, on the boundary or inside: φ may have simple poles there
    Eigen::VectorXcd tangents = {};  ///< #V of the true boundary curves in the chart, any length and sign; ignored at
                                     ///< inner vertices; empty: of the circles through three neighbours of a loop
    double least_gap = 50;           ///< of the eigenvalues, below which a warning is given
    /// A solver to be factorised and used if its freedoms are those that the fields V have (else one is made): the
    /// ordering and analysis of its system need not be done twice.
    BeltramiSolver* solver = nullptr;
    /// @throw Error bad_option if a value is impossible
    void validate(const Surface& source) const;
};

struct ProjectedSpace {
    TabulatedSpace space;         ///< functions orthonormal in L² of the chart, weakened towards marked points
    int dimension = 0;            ///< of the space: that of the theory
    Eigen::VectorXd eigenvalues;  ///< of the projected seeds' Gram matrix, descending; the seeds have length 1
    double gap = 0;               ///< the last eigenvalue of the space over the next one; infinite if there is none
    Warnings warnings;
};

/// The quadratic differentials with φ τ² real on the boundary of any domain with smooth boundary, by L² projection: φ
/// belongs to the space exactly if Re ∫ φ ∂̄V = 0 for every field V that is tangential along the boundary and vanishes
/// at marked points. Each seed ψ is projected by one linear solve, φ = conj(ψ − ∂̄V) with V = argmin ∫ |ψ − ∂̄V|²; of the
/// φ, smoothed (differential_smoothing.h), as many are kept as the theory says (dimension_of_differentials), those with
/// the largest eigenvalues: the others are errors of the discretisation.
///
/// Seeds are conjugates of 1/((z − a)(z − b)), for a and b in the holes or marked. A corner of the boundary that is not
/// marked behaves like a marked one, V having two tangents there: then φ has a pole that does not belong
/// (one_form_squares.h has quadrilaterals with corners).
///
/// The metric is the source's own; @p chart is needed for seeds and tangents, and may be plane_chart of a planar
/// source. Samples that it excludes are given 0.
/// @param chart with a place inside every hole
/// @throw Error bad_mesh unless there is one component of genus 0 with boundary; bad_option; not_solved where no gap
///        shows a space of the right dimension
ProjectedSpace projected_space(const Surface& source, const Chart& chart, const ProjectionOptions& options = {});

/// The same with seeds of one's own, whose projections have to span the space and be little else.
/// @param seeds #S × any number: values of ψ in the chart
ProjectedSpace projected_space(const Surface& source, const Chart& chart, const Eigen::MatrixXcd& seeds,
                               const ProjectionOptions& options);

}  // namespace beltrami
