#pragma once

#include <array>
#include <string>
#include <vector>

namespace beltrami {

/// A surface deformed by handles.
struct DeformRecord {
    std::string surface;    ///< which one the result lies on (applications/deform.h)
    std::string minimized;  ///< "K", "max" or "spread": what was made small of the map onto it
    int handles = 0;
    double mean_before = 0, max_before = 0;  ///< |μ| of that surface's own vertices
    double area_ratio = 1;                   ///< of the result to the source
    std::vector<std::array<int, 2>> folds;   ///< edges at which the result folds
};

}  // namespace beltrami
