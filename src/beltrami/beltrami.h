#pragma once

/// The one header that most users include.

#include <beltrami/baselines/baseline.h>
#include <beltrami/conformal/boundary_values.h>
#include <beltrami/conformal/flatten.h>
#include <beltrami/conformal/round_disk.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/maps/composition.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>
#include <beltrami/teichmuller/extremal_map.h>
