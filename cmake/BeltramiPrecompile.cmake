# Precompiles the headers of others that most files include (Eigen, the standard library, those in ARGN) once for a family
# of targets compiled alike. Every file includes what it needs all the same: `./run lint` compiles without.
function(beltrami_precompile family target)
    if(NOT BELTRAMI_QUICK_BUILD)
        return()
    endif()
    get_property(owner GLOBAL PROPERTY beltrami_precompiled_${family})
    if(owner)
        target_precompile_headers(${target} REUSE_FROM ${owner})
        return()
    endif()
    set_property(GLOBAL PROPERTY beltrami_precompiled_${family} ${target})
    target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore> <algorithm> <array> <cmath>
        <complex> <functional> <limits> <memory> <numbers> <numeric> <optional> <random> <string> <utility> <vector> ${ARGN})
endfunction()
