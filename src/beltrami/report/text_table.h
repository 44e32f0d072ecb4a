#pragma once

#include <string>
#include <vector>

namespace beltrami {

/// Rows of cells as lines for the terminal: the first column to the left, the others to the right, columns whose cells
/// below the head are all empty left out.
/// @param rows the head first; all of one length
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace beltrami
