# beltrami_page(<folder> <result>): bundles the page of <folder> with npm's packages into one HTML file, whose path <result>
# gets. Copies are bundled, so that nothing is written beside the sources.
set(BELTRAMI_PAGE "" CACHE FILEPATH "The report page as it was bundled elsewhere; empty: bundled here, with npm")
function(beltrami_page folder result)
    if(BELTRAMI_PAGE)
        set(${result} ${BELTRAMI_PAGE} PARENT_SCOPE)
        return()
    endif()
    find_program(NPM npm)
    if(NOT NPM)
        message(FATAL_ERROR "The report page is bundled with npm, which is not there: install nodejs and npm, or give the "
            "page that another build bundled (page/dist/index.html of its folder) with -DBELTRAMI_PAGE=FILE.")
    endif()
    set(work ${CMAKE_CURRENT_BINARY_DIR}/page)
    set(packages ${folder}/package.json ${folder}/package-lock.json)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.js ${folder}/*.css ${folder}/*.html)
    add_custom_command(OUTPUT ${work}/packages.stamp VERBATIM DEPENDS ${packages} COMMENT "Fetching the page's npm packages"
        COMMAND ${CMAKE_COMMAND} -E make_directory ${work}
        COMMAND ${CMAKE_COMMAND} -E copy ${packages} ${work}
        COMMAND ${NPM} ci --prefer-offline --silent --no-audit --no-fund --prefix ${work}
        COMMAND ${CMAKE_COMMAND} -E touch ${work}/packages.stamp)
    add_custom_command(OUTPUT ${work}/dist/index.html VERBATIM DEPENDS ${work}/packages.stamp ${sources}
        COMMENT "Bundling the page"
        COMMAND ${CMAKE_COMMAND} -E copy ${sources} ${work}
        COMMAND ${NPM} run --silent build --prefix ${work})
    set(${result} ${work}/dist/index.html PARENT_SCOPE)
endfunction()
