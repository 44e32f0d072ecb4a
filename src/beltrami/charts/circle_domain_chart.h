#pragma once

#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/plane/circle_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

struct CircleDomainOptions {
    int max_steps = 30;       ///< Newton steps of the sliding rims
    double tolerance = 1e-7;  ///< the last step is one that promises to lower the energy by less than this part
    /// An exact chart whose rims, made rounder by an analytic map, miss circles by no more than this part of the
    /// distance between chord and arc is kept exact: the rims only snap to their circles. 0: none but round ones.
    double exact_part = 0.1;
    /// Circles that come closer, relative to the radius of the smaller one, are refused.
    double least_gap = 1e-3;
    HoleRoundingOptions rounding{1 + 1e-9, 15, 30};  ///< of exact charts
    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// A conformal map of a surface of genus 0 to a circle domain, drawn with the surface's own faces.
struct CircleDomainChart {
    /// Vertices of the outer loop lie on the unit circle, those of the other loops on the circles of their holes, to
    /// rounding. chart.holes are the circles too.
    Chart chart;
    std::vector<RoundHole> holes;  ///< one for every loop but the outer one, in their order

    double roundness = 0;  ///< largest distance of a rim vertex from its circle before it was put there, relative to
                           ///< the radius: of the start where the rims slid
    double mean_mu = 0;    ///< |μ| of the map that is linear on the faces
    double standard_deviation = 0;
    double max_mu = 0;
    std::vector<int> flipped;  ///< flipped faces: at most what pinched faces force
    /// Faces with an inner edge between two vertices of one hole. That edge runs across the hole of the circle domain,
    /// so that it or a face behind it is flipped whatever the map: to be split in the surface.
    std::vector<int> pinched;
    int steps = 0;          ///< Newton steps
    bool converged = true;  ///< the last step was below the tolerance
    int factorizations = 0;
    int harmonic_solves = 0;  ///< with a factor at hand, while the rims slide

    int outer_loop() const { return chart.outer_loop; }
    /// The circle of a boundary loop: the unit circle for the outer one.
    /// @pre the loop exists
    RoundHole circle(int loop) const;
};

/// The conformal map of a surface of genus 0 with boundary, in the plane, in space or with a metric of its own, to the
/// unit disk with round holes, @p outer_loop on the unit circle. Without holes: the round disk. It is unique up to
/// Möbius maps of the disk and normalised as domain_chart is, to discretisation where the rims slide.
///
/// - A planar circle domain: domain_chart's similarity or Möbius map, exact.
/// - Else domain_chart, its holes made rounder by an analytic map. A planar source with a round outer loop keeps an
///   exact chart if the rims are round enough after that (options.exact_part).
/// - Else the rims snap to the nearest circles, the correction extended harmonically, and Newton steps lower the
///   conformal energy Σ A|∂̄f|² over all f whose rims lie on circles: every rim vertex slides along its circle,
///   the centre and radius of every hole are unknowns too, three vertices of the outer loop are held
///   (docs/conformal.md). The minimum is zero exactly for the conformal map; f's error is of second order.
/// Faces that come out flipped are unfolded with the rims fixed (fold_free_map); chart.warnings records it.
/// @throw Error bad_option if there is no such loop; bad_mesh unless there is one component of genus 0 with boundary;
///        not_solved if circles come too close to each other or faces stay flipped (but for those that pinched
///        faces force)
CircleDomainChart circle_domain_chart(const Surface& source, int outer_loop = 0,
                                      const CircleDomainOptions& options = {});

}  // namespace beltrami
