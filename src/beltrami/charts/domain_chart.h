#pragma once

#include <beltrami/base/public.h>
#include <beltrami/charts/hole_rounding.h>
#include <beltrami/charts/round_disk.h>

namespace beltrami BELTRAMI_PUBLIC {

struct DomainChartOptions {
    double round_from = 1.2;  ///< holes are made rounder where one has a larger ratio (hole_centre.h); infinite: never
    HoleRoundingOptions rounding = {};
    RoundDiskOptions disk = {};
    /// A surface that is not planar is mapped by way of a round annulus where a hole has so many vertices, else by way
    /// of the filled disk.
    int least_rim = 24;
};

/// The conformal map of a surface of genus 0 with any number of boundary loops to the unit disk with holes, @p
/// outer_loop on the unit circle, normalised so that the source's area is centred at 0.
///
/// - A disk: round_disk_chart.
/// - A planar source whose outer loop lies on a circle: a similarity if it is the geometric outer loop, else the
///   inversion in it followed by a Möbius map of the disk (exact = true, analytic).
/// - Any other planar source: the holes are filled in the plane (fill_holes) and the chart is the round disk's of the
///   filled domain. Where another loop than the geometric outer one goes outside, the source is first turned inside
///   out, by inversion in a place inside that loop.
/// - A surface in space or with a metric of its own: the hole with the most vertices stays open, the others are filled,
///   and the chart is the round annulus's (annulus_map). Where no hole has options.least_rim vertices all are filled
///   and the chart is the round disk's of the filled surface, which costs a flattening.
///
/// Then, where holes are far from round, they are made rounder by an analytic map (round_holes); where that does not
/// succeed the chart is kept as it is. It improves only how well series about the centres of the holes are
/// conditioned.
/// @param dirichlet a solver that fixes exactly the boundary, factorised for the coefficient 0, or null; of use for a
///                  disk only
/// @throw Error bad_option if there is no such loop; bad_mesh unless there is one component of genus 0 with boundary;
///        not_solved
Chart domain_chart(const Surface& source, int outer_loop = 0, const BeltramiSolver* dirichlet = nullptr,
                   const DomainChartOptions& options = {});

/// The coordinates of a planar source, moved and scaled into the unit disk: exact for any outline, but series converge
/// the slower the less round it is. For outlines with corners that the mesh resolves poorly, where the Riemann map is
/// inaccurate.
/// @pre source.in_plane(), one component of genus 0 with boundary; the outer loop is the geometric one
Chart plane_chart(const Surface& source);

}  // namespace beltrami
