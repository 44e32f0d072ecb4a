#pragma once

#include <functional>

#include "map_methods.h"

namespace beltrami::cli {

/// Maps the components of a surface one by one and puts their images in a row, from left to right with gaps, each as it
/// comes. Fills the record's map, solve, split, components and warnings.
/// @param map_one maps one component; fills the record it is given
/// @return the mesh with everything that was added to it, the map of the whole
MethodResult map_components(const Surface& source,
                            const std::function<MethodResult(const Surface& component, Record& record)>& map_one,
                            Record& record);

}  // namespace beltrami::cli
