#pragma once

#include <filesystem>
#include <string>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// All bytes of a regular file or a pipe.
/// @throw Error unreadable with the system's reason
std::string read_file(const std::filesystem::path& path);

}  // namespace beltrami
