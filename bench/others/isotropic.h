#pragma once

#include <optional>

#include <beltrami/mesh/mesh.h>

/// CGAL's isotropic remeshing of a mesh, its quads cut: splits, collapses, flips and relaxations.
/// @param edge       length of the edges that is wanted
/// @param features   radians: edges at which faces turn by more are kept
beltrami::Mesh isotropic_remeshing(const beltrami::Mesh& mesh, double edge, int iterations,
                                   std::optional<double> features);
