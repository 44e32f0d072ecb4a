#pragma once

#include <beltrami/baselines/baseline.h>
#include <beltrami/report/page.h>
#include <beltrami/report/record.h>
#include <beltrami/teichmuller/least_dilatation.h>

#include "onto_options.h"

namespace beltrami::cli {

/// Names of the methods besides "extremal".
const std::vector<std::string>& baseline_names();

/// A map with what the outputs show of it. The mesh is the source's, or the split one.
struct MethodResult {
    std::optional<Surface> split;        ///< the mesh that was mapped, if it is not the source itself
    std::vector<int> face_parents;       ///< of split: the source's face of each of its faces
    Eigen::VectorXcd map;                ///< #V
    Distortion distortion;               ///< of map
    std::vector<PageMap> pages;          ///< the map first
    std::optional<Positions> positions;  ///< #V images on a target that is a surface
    std::vector<MeshPoint> places;       ///< #V the same on its faces
    std::vector<Iteration> history;
    QuadraticDifferential differential;  ///< of an extremal map
    Eigen::VectorXcd phi;                ///< #S its values, as the c-step had them; of others empty
};

/// Lets the page of an extremal map show its φ. Nothing of other maps, nor in a metric in which the mesh is not drawn.
void show_differential(const Surface& mapped, MethodResult& result);

/// The extremal map or that of least maximum. Fills the record's map, solve, homotopy, corners, split, least_maximum
/// and warnings.
/// @param start      when the clock was started
/// @param show       whether the terminal may show the iterations
MethodResult run_least_dilatation(const Surface& source, const Constraints& constraints, LeastDilatationOptions options,
                                  double start, bool show, Record& record);

/// The extremal map with a proof; fills certificate too.
/// @param gap wanted of the bracket of K
MethodResult run_certified(const Surface& source, const Constraints& constraints, ExtremalOptions options, double gap,
                           double start, bool show, Record& record);

/// The extremal map onto a surface with prescribed boundary; fills correspondence too.
/// @param boundary becomes the values on the target's circle domain, for other methods
MethodResult run_between(const Surface& source, const OntoTarget& target, const Correspondence& wanted,
                         ExtremalOptions options, double start, bool show, Record& record, BoundaryCondition& boundary);

/// Names of the methods that can be set beside it where the boundary slides.
const std::vector<std::string>& sliding_baseline_names();

/// The extremal map onto a target; fills onto too.
/// @param compare further methods for the record's comparison and the pages
MethodResult run_onto(const Surface& source, const OntoTarget& target, const Constraints& constraints,
                      ExtremalOptions options, double start, bool show, Record& record,
                      const std::vector<std::string>& compare = {});

/// Another method.
MethodResult run_baseline(const Surface& source, const BoundaryCondition& boundary, const std::string& method,
                          const BaselineOptions& options, double start, MethodRecord& record, Warnings& warnings);

}  // namespace beltrami::cli
