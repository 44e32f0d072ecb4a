#pragma once

/// The one header that most users include.

#include <beltrami/baselines/baseline.h>
#include <beltrami/conformal/boundary_values.h>
#include <beltrami/conformal/flatten.h>
#include <beltrami/conformal/round_disk.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/planar_domains.h>
#include <beltrami/generate/quality.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/maps/boundary_corners.h>
#include <beltrami/maps/boundary_feasibility.h>
#include <beltrami/maps/composition.h>
#include <beltrami/maps/even_dilatation.h>
#include <beltrami/maps/fold_free.h>
#include <beltrami/maps/prescribed_split.h>
#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>
#include <beltrami/teichmuller/certificate.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/extremal_solver.h>
