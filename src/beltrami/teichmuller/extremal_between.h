#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/boundary_correspondence.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface onto which a boundary is prescribed, by way of its circle domain.
struct PrescribedTarget {
    CircleDomainChart circles;              ///< of the target
    BoundaryCorrespondence correspondence;  ///< of the boundaries
    BoundaryCondition boundary;             ///< the same as values on the circles
};

/// @param pairs      see boundary_correspondence
/// @param outer_loop of the source: its partner goes to the unit circle
/// @param shapes     surfaces whose charts are kept; the target is asked for its own
/// @throw Error bad_option if there is no such loop; bad_mesh unless the target has one component of genus 0 with
///        boundary; bad_boundary, not_solved
PrescribedTarget prescribed_target(const Surface& source, const Surface& target,
                                   std::span<const std::array<int, 2>> pairs, int outer_loop = 0,
                                   const std::vector<const Shape*>& shapes = {});

/// Places on the target of a map to its circle domain: those of boundary vertices of the source are the ones that were
/// prescribed, the others are located.
/// @param map #V or more images: further vertices, as of split edges, follow those of the source
std::vector<MeshPoint> places_on_target(const Surface& source, const Surface& target, const PrescribedTarget& where,
                                        const Eigen::VectorXcd& map);

/// An extremal map onto a surface whose boundary is prescribed.
struct ExtremalMapBetween {
    /// To the target's circle domain. Its bounds are estimates all, since the circle domain is conformal up to the
    /// error of the mesh: none is rigorous.
    ExtremalMap plane;
    PrescribedTarget target;
    std::vector<MeshPoint> places;  ///< #V places on the target's faces
    Positions positions;            ///< #V their positions
};

/// The extremal map of a surface of genus 0 with boundary onto another one, in the plane or in space, with prescribed
/// boundary correspondence: pairs of vertices, arc length between them. It does not change when the target is changed
/// conformally, so the map goes to the target's circle domain (extremal_map.h), and from there to its faces.
/// @param pairs   see boundary_correspondence
/// @param wanted  its outer loop and class; waypoints are in the target's circle domain
/// @param options a start is a map to the target's circle domain
/// @throw Error bad_mesh, bad_boundary, bad_option, not_solved, cancelled
ExtremalMapBetween extremal_map_between(const Surface& source, const Surface& target,
                                        std::span<const std::array<int, 2>> pairs, const Correspondence& wanted = {},
                                        const ExtremalOptions& options = {});

}  // namespace beltrami
