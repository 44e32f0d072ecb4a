#pragma once

#include <cstdlib>
#include <filesystem>

namespace beltrami::test {

/// A file of the folder of real meshes (BELTRAMI_TEST_MESHES); empty where there is no such file, then the test is to
/// be skipped.
inline std::filesystem::path real_mesh(const char* name) {
    const char* const folder = std::getenv("BELTRAMI_TEST_MESHES");
    if (!folder) return {};
    std::filesystem::path path = std::filesystem::path(folder) / name;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace beltrami::test
