#pragma once

#include <string>

#include <beltrami/applications/deformed_picture.h>

namespace beltrami::cli {

/// A PNG of any kind as red, green, blue and opacity of 8 bits.
/// @throw Error unreadable, also where the command was built without libpng
Picture read_png(const std::string& path);

/// @throw Error unwritable
void write_png(const std::string& path, const Picture& picture);

}  // namespace beltrami::cli
