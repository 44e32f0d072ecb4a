#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beltrami::cli {

/// The numbers of "a,b,…"; nothing if it is no such list.
std::optional<std::vector<double>> number_list(std::string_view text);

/// The loop and the rest of "h=rest"; nothing if h is no whole number from 0.
std::optional<std::pair<int, std::string>> of_loop(std::string_view text);

/// A whole number; nothing if the text is none.
std::optional<int> whole_number(std::string_view text);

}  // namespace beltrami::cli
