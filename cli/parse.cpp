#include "parse.h"

#include <beltrami/io/text_scanner.h>

namespace beltrami::cli {

std::optional<std::vector<double>> number_list(std::string_view text) {
    std::vector<double> values;
    for (;;) {
        const std::size_t comma = text.find(',');
        const std::optional<double> value = spelled_number<double>(text.substr(0, comma));
        if (!value) return {};
        values.push_back(*value);
        if (comma == std::string_view::npos) return values;
        text.remove_prefix(comma + 1);
    }
}

std::optional<std::pair<int, std::string>> of_loop(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return {};
    const std::optional<int> loop = whole_number(text.substr(0, equals));
    if (!loop || *loop < 0) return {};
    return std::pair{*loop, std::string(text.substr(equals + 1))};
}

std::optional<int> whole_number(std::string_view text) {
    return spelled_number<int>(text);
}

}  // namespace beltrami::cli
