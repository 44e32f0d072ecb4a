#pragma once

#include <filesystem>
#include <string>

namespace beltrami {

/// All bytes of a regular file or a pipe.
/// @throw Error unreadable with the system's reason
std::string read_file(const std::filesystem::path& path);

}  // namespace beltrami
