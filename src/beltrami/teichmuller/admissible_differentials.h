#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <beltrami/base/warning.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/singularities.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/teichmuller/extremal_options.h>

namespace beltrami {

class Shape;

/// The admissible differentials of a source some or all of whose boundary slides, and the chart in which they are
/// written down.
struct AdmissibleDifferentials {
    /// To the source's circle domain; the frames of the samples where φ is tabulated on any surface; the source's own
    /// coordinates where it slides along straight sides.
    Chart chart;
    std::unique_ptr<DifferentialSpace> space;  ///< null where there are none: the map is conformal
    bool grows = false;                        ///< larger spaces are worth while
    Singularities singularities;               ///< where they vary quickly
    std::vector<int> poles;                    ///< vertices at which φ may have simple poles, ascending
    std::optional<int> expected_dimension;     ///< where theory says it and the space does not grow
    double gap = 0;                            ///< how clearly the dimension was told
    ExtremalOptions::Space kind = ExtremalOptions::Space::laurent;
    Warnings warnings;
};

/// Those of a source all of whose boundary slides.
/// @param domain    of the source
/// @param wanted    how they are to be found
/// @param marked    vertices in the order of the loops
/// @param dimension by theory
/// @param solver    of the source's f-step, which projections may use; or null
/// @param shape     of the source, which keeps what projections find; or null
/// @throw Error bad_option, not_solved
AdmissibleDifferentials admissible_differentials(const Surface& source, const CircleDomainChart& domain,
                                                 ExtremalOptions::Space wanted, const std::vector<int>& marked,
                                                 int dimension, BeltramiSolver* solver, const Shape* shape = nullptr);

}  // namespace beltrami
