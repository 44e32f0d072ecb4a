# One folder of src/beltrami is one layer. Each layer is an object library whose include path holds its own headers and
# those of the layers it may use, nothing else: an #include of a layer further down does not compile.
#
#   beltrami_layer(<name> [USES <layer>...] [LIBRARIES <target>...] [WITHOUT <file>...] [PRIVATE <header>...])
#
# USES names the layers directly above; theirs come along. LIBRARIES are private third-party targets. WITHOUT names
# files of the folder that beltrami_choice() compiles, of which a library takes one. PRIVATE headers are seen by the layer
# itself and its tests alone. Files are compiled a dozen at a time (BELTRAMI_QUICK_BUILD), so a name that is a file's own is
# no other's in its folder.
set(BELTRAMI_LAYERS "" CACHE INTERNAL "")

# Links in the folder <open> to the headers of <folder> that are not private.
function(beltrami_open_headers folder open)
    file(REMOVE_RECURSE ${open})
    file(MAKE_DIRECTORY ${open})
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.h)
    list(REMOVE_ITEM headers ${ARGN})
    foreach(header IN LISTS headers)
        file(CREATE_LINK ${folder}/${header} ${open}/${header} SYMBOLIC)
    endforeach()
endfunction()

# Lets a target see all headers of a layer.
function(beltrami_own_headers layer target)
    set(stage ${CMAKE_CURRENT_BINARY_DIR}/layers/${layer}.own)
    file(MAKE_DIRECTORY ${stage}/beltrami)
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/src/beltrami/${layer} ${stage}/beltrami/${layer} SYMBOLIC)
    target_include_directories(${target} BEFORE PRIVATE ${stage})
endfunction()

function(beltrami_layer name)
    cmake_parse_arguments(ARG "" "" "USES;LIBRARIES;WITHOUT;PRIVATE" ${ARGN})
    set(folder ${CMAKE_CURRENT_SOURCE_DIR}/src/beltrami/${name})
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.h)
    list(TRANSFORM ARG_WITHOUT PREPEND ${folder}/)
    list(REMOVE_ITEM sources ${ARG_WITHOUT})
    set(stage ${CMAKE_CURRENT_BINARY_DIR}/layers/${name})
    file(MAKE_DIRECTORY ${stage}/beltrami)
    set(open ${stage}/beltrami/${name})
    if(IS_SYMLINK ${open})
        file(REMOVE ${open})
    endif()
    if(ARG_PRIVATE)
        beltrami_open_headers(${folder} ${open} ${ARG_PRIVATE})
    else()
        file(CREATE_LINK ${folder} ${open} SYMBOLIC)
    endif()

    add_library(beltrami_${name} OBJECT ${sources})
    target_compile_features(beltrami_${name} PUBLIC cxx_std_20)
    target_include_directories(beltrami_${name} PUBLIC $<BUILD_INTERFACE:${stage}>)
    if(ARG_PRIVATE)
        beltrami_own_headers(${name} beltrami_${name})
    endif()
    target_link_libraries(beltrami_${name} PUBLIC $<BUILD_INTERFACE:Eigen3::Eigen> Threads::Threads)
    target_link_libraries(beltrami_${name} PRIVATE $<BUILD_INTERFACE:beltrami_warnings> ${ARG_LIBRARIES})
    foreach(layer IN LISTS ARG_USES)
        # Headers only: the objects are collected once, in the library.
        target_include_directories(beltrami_${name} PUBLIC
            $<BUILD_INTERFACE:$<TARGET_PROPERTY:beltrami_${layer},INTERFACE_INCLUDE_DIRECTORIES>>)
    endforeach()
    set_target_properties(beltrami_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    beltrami_few_at_a_time(beltrami_${name} 12)
    set(BELTRAMI_LAYERS ${BELTRAMI_LAYERS} ${name} CACHE INTERNAL "")
endfunction()

# One file of a layer that a library takes or leaves, as the object library beltrami_<file>:
#
#   beltrami_choice(<layer> <file> [LIBRARIES <target>...])
function(beltrami_choice layer file)
    cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
    add_library(beltrami_${file} OBJECT EXCLUDE_FROM_ALL src/beltrami/${layer}/${file}.cpp)
    beltrami_own_headers(${layer} beltrami_${file})
    target_link_libraries(beltrami_${file} PRIVATE beltrami_${layer} beltrami_warnings ${ARG_LIBRARIES})
    set_target_properties(beltrami_${file} PROPERTIES POSITION_INDEPENDENT_CODE ON
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
