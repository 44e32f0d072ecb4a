#pragma once

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace beltrami::bench {

/// The arguments of a program as whole numbers from @p least on, or @p defaults where there are none. Anything else is
/// answered by the usage, and the program ends.
inline std::vector<int> numbers_of(int argc, char** argv, int least, std::vector<int> defaults, const char* usage) {
    if (argc < 2) return defaults;
    std::vector<int> numbers;
    for (int i = 1; i < argc; ++i) {
        int number = 0;
        const char* const end = argv[i] + std::strlen(argv[i]);
        const auto [stop, error] = std::from_chars(argv[i], end, number);
        if (error != std::errc() || stop != end || number < least) {
            std::fprintf(stderr, "usage: %s\n", usage);
            std::exit(2);
        }
        numbers.push_back(number);
    }
    return numbers;
}

}  // namespace beltrami::bench
