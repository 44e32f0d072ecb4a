#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// ".obj" for "Fish.OBJ"; empty if the name has no extension.
inline std::string lower_case_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

}  // namespace beltrami
