#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace beltrami::cli {

/// The manual page of the command and all its subcommands (roff, UTF-8), from its own parser.
/// @param exit_codes the text that help texts end with
std::string manual_page(const CLI::App& app, const std::string& version, const std::string& exit_codes);

/// Scripts that complete subcommands, options and their values in a shell, from the command's own parser.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace beltrami::cli
