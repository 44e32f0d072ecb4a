# Debian packages of what is installed: beltrami (the command), libbeltrami0 and libbeltrami-dev, where the library is
# shared, and python3-beltrami, where its module is built. `cpack` in the build folder makes them; `./run deb` does all.

# Manual page and completion, as the command writes them.
set(share ${PROJECT_BINARY_DIR}/share)
add_custom_command(OUTPUT ${share}/beltrami.1.gz ${share}/beltrami.bash ${share}/_beltrami DEPENDS beltrami_command
    COMMAND ${CMAKE_COMMAND} -E make_directory ${share}
    COMMAND $<TARGET_FILE:beltrami_command> --write manual | gzip -9n > ${share}/beltrami.1.gz
    COMMAND $<TARGET_FILE:beltrami_command> --write bash > ${share}/beltrami.bash
    COMMAND $<TARGET_FILE:beltrami_command> --write zsh > ${share}/_beltrami
    COMMENT "Writing the manual page and completions")
add_custom_target(beltrami_manual ALL DEPENDS ${share}/beltrami.1.gz)
install(FILES ${share}/beltrami.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command OPTIONAL)
install(FILES ${share}/beltrami.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME beltrami
    COMPONENT command OPTIONAL)
install(FILES ${share}/_beltrami DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command OPTIONAL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The beltrami maintainers <maintainers@beltrami.invalid>" CACHE STRING "Maintainer of the packages")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL command library dev)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY =)
set(text "Among all maps of a surface to the plane with given boundary values\nbeltrami finds the one that stretches least, and brackets how far\nfrom least it can be.")

# beltrami_package(<component> <package> <section> <what it is> [<depends>])
function(beltrami_package component package section what)
    string(TOUPPER ${component} name)
    set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package} PARENT_SCOPE)
    set(CPACK_DEBIAN_${name}_PACKAGE_SECTION ${section} PARENT_SCOPE)
    set(CPACK_DEBIAN_${name}_DESCRIPTION "${text}\nThis package has ${what}." PARENT_SCOPE)
    if(ARGN)
        set(CPACK_DEBIAN_${name}_PACKAGE_DEPENDS "${ARGN}" PARENT_SCOPE)
    endif()
    set(documents ${CMAKE_INSTALL_DATADIR}/doc/${package})
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${documents} RENAME copyright COMPONENT ${component})
    install(CODE "
        string(TIMESTAMP date \"%a, %d %b %Y %H:%M:%S +0000\" UTC)
        file(WRITE ${share}/${package}.changelog \"${package} (${PROJECT_VERSION}) unstable; urgency=medium

  * Version ${PROJECT_VERSION}: CHANGELOG.md of the project.

 -- ${CPACK_PACKAGE_CONTACT}  \${date}
\")
        execute_process(COMMAND gzip -9nf ${share}/${package}.changelog COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
    install(FILES ${share}/${package}.changelog.gz DESTINATION ${documents} RENAME changelog.gz COMPONENT ${component})
endfunction()
beltrami_package(command beltrami math "the command")
beltrami_package(library libbeltrami0 libs "the library")
beltrami_package(dev libbeltrami-dev libdevel "headers" "libbeltrami0 (= ${PROJECT_VERSION}), libeigen3-dev (>= 3.4)")
file(WRITE ${share}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${share}/triggers)
set(CPACK_COMPONENT_COMMAND_DEPENDS library)
if(TARGET beltrami_python)
    beltrami_package(python python3-beltrami python "the module of Python 3.11"
        "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-scipy")
    set(module lib/python3/dist-packages/beltrami)
    install(TARGETS beltrami_python LIBRARY DESTINATION ${module} COMPONENT python OPTIONAL)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/beltrami/ DESTINATION ${module} COMPONENT python
        FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed)
    list(APPEND CPACK_COMPONENTS_ALL python)
endif()
include(CPack)
