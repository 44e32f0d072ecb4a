#include <cstddef>
#include <cstdint>
#include <string_view>

#include <beltrami/base/error.h>
#include <beltrami/io/read_mesh.h>

/// Any bytes are either read or refused with an Error; everything else is a bug.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        beltrami::read_ply({reinterpret_cast<const char*>(data), size}, "fuzz.ply");
    } catch (const beltrami::Error&) {
    }
    return 0;
}
