# beltrami_embed(<target> <symbol> <file>): embeds a file in <target> as an array of bytes, beltrami::<symbol> and
# beltrami::<symbol>Size. The file may be one that the build makes. As a script (-DFILE, -DSYMBOL, -DOUT) it writes the array.
if(CMAKE_SCRIPT_MODE_FILE)
    file(READ ${FILE} bytes HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    file(WRITE ${OUT} "#include <cstddef>
namespace beltrami {
extern const unsigned char ${SYMBOL}[];
extern const std::size_t ${SYMBOL}Size;
const unsigned char ${SYMBOL}[] = {${bytes}};
const std::size_t ${SYMBOL}Size = sizeof(${SYMBOL});
}  // namespace beltrami
")
    return()
endif()

set(BELTRAMI_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(beltrami_embed target symbol file)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.cpp)
    add_custom_command(OUTPUT ${source} VERBATIM DEPENDS ${file} ${BELTRAMI_EMBED_SCRIPT} COMMENT "Embedding ${file}"
        COMMAND ${CMAKE_COMMAND} -DFILE=${file} -DSYMBOL=${symbol} -DOUT=${source} -P ${BELTRAMI_EMBED_SCRIPT})
    target_sources(${target} PRIVATE ${source})
endfunction()
