# Compiles COUNT files of a target at a time (BELTRAMI_QUICK_BUILD): what they share is read and instantiated once for all.
function(beltrami_few_at_a_time target count)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${BELTRAMI_QUICK_BUILD} UNITY_BUILD_BATCH_SIZE ${count})
endfunction()

# For a program whose own code is compiled with few optimisations, in less than half the time, since it is not where the time
# of running goes. The whole library comes first: of inline functions and templates that it and the program both compile,
# the program then takes the library's copies, compiled as the library is.
function(beltrami_library_first target library)
    target_link_options(${target} PRIVATE "LINKER:--whole-archive,$<TARGET_FILE:${library}>,--no-whole-archive")
endfunction()
