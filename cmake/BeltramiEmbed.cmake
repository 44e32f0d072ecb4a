# Embeds a file in <target> as an array of bytes, beltrami::<symbol> and beltrami::<symbol>Size. Where it says
# @name.ext@, the further file of that name is put in. All are read again when one of them changes.
function(beltrami_embed target symbol file)
    file(READ ${file} bytes HEX)
    foreach(part IN LISTS ARGN)
        file(READ ${part} part_bytes HEX)
        cmake_path(GET part FILENAME name)
        string(HEX "@${name}@" mark)
        string(REPLACE "${mark}" "${part_bytes}" bytes "${bytes}")
    endforeach()
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cpp @ONLY CONTENT "#include <cstddef>
namespace beltrami {
extern const unsigned char @symbol@[];
extern const std::size_t @symbol@Size;
const unsigned char @symbol@[] = {@bytes@};
const std::size_t @symbol@Size = sizeof(@symbol@);
}  // namespace beltrami
")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file} ${ARGN})
    target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cpp)
endfunction()
