#pragma once

#include <cstddef>
#include <string>

namespace beltrami {

/// "1 face is flipped", "3 faces are flipped".
inline std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace beltrami
