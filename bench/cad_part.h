#pragma once

#include <beltrami/mesh/mesh.h>

/// A part as a CAD program has it: a plate in the shape of an L with a bore, extruded, its edges sharp.
/// @param edge length of the triangles' edges
beltrami::Mesh cad_part(double edge);
