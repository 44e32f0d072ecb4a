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

# Compiles the files of a target few at a time: what they share is read and instantiated once for all of them. Those in
# ARGN stay alone.
function(beltrami_few_at_a_time target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${BELTRAMI_QUICK_BUILD} UNITY_BUILD_BATCH_SIZE 6)
    if(ARGN)
        set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
endfunction()
