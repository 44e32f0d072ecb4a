#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <beltrami/base/public.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Reads a target domain: {"outer": LOOP, "holes": [LOOP, …]}, holes optional, where LOOP is {"circle": [x, y, r]},
/// {"polygon": [[x, y], …]} or {"spline": [[x, y], …]}, in either direction.
/// @throw Error unreadable if the file is missing or no JSON (naming line and column); bad_option naming the file, the
///        loop and what is wrong with it
TargetDomain read_target_domain(const std::filesystem::path& path);

/// Writes what read_target_domain reads: the same curves to the last bit, at once or not at all.
/// @throw Error unwritable
void write_target_domain(const std::filesystem::path& path, const TargetDomain& domain);

/// The same from and to text. @param name of the file, for sentences
TargetDomain parse_target_domain(std::string_view text, const std::string& name);
std::string format_target_domain(const TargetDomain& domain);

}  // namespace beltrami
