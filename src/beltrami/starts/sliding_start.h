#pragma once

#include <beltrami/base/public.h>
#include <beltrami/plane/disk_moebius.h>
#include <beltrami/solve/sliding_boundary.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map of the right class from which boundaries can slide.
struct SlidingStart {
    Eigen::VectorXcd map;            ///< #V in the target's plane, boundary vertices on their curves
    std::vector<SlidingLoop> loops;  ///< in the order of the source's loops; marked vertices are held
    std::vector<int> curves;         ///< of every loop
    DiskMoebius move;                ///< of the source's circle domain, towards the model (loop_partners.h)
    std::vector<Waypoint> path;      ///< that was followed, in the model
    bool led = false;                ///< along the path; else the map is harmonic
    int flips = 0;                   ///< of the harmonic map
    bool unfolded = false;           ///< its folds were opened
    int factorizations = 0;
};

/// Loops are matched, the source's circle domain is moved towards the model by a Möbius map (loop_partners.h), and
/// every circle goes to its partner evenly (between marks if there are any). The harmonic map with these values is the
/// start if it has no folds and no way is prescribed. Where it has folds and nothing says how loops are to be turned,
/// they are turned first so that it is not twisted (untwisting.h). Then the holes are led along their way
/// (continuation.h) in the unit disk of the model, and the result is carried to the target.
/// @param chart circle domain of the source
/// @param start_turns every loop's vertices start so many radians ahead of where they would, one number per loop of the
///                    source; empty: none. What is found from the start does not depend on it.
/// @throw Error bad_boundary, bad_option, not_solved
SlidingStart sliding_start(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                           const Correspondence& wanted, const std::vector<double>& start_turns = {});

/// The same before anything is done about its folds: every circle evenly to its partner and, inside, the harmonic map.
/// @param wanted without marks and waypoints
SlidingStart even_start(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                        const Correspondence& wanted, const std::vector<double>& start_turns = {});

/// Holds as many vertices of the outer loop as conformal maps of the source to itself leave free, spread evenly: one of
/// an annulus, three of a disk, less the marks.
/// @param outer the outer loop
/// @param marks how many vertices are marked
void hold_what_conformal_maps_move(std::vector<SlidingLoop>& loops, int outer, std::size_t marks);

}  // namespace beltrami
