#include <beltrami/io/number_lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <beltrami/io/read_file.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

/// True, and the word is passed over, if the next one is `*`.
bool pass_star(TextScanner& scanner) {
    if (scanner.at_line_end() || scanner.rest().front() != '*') return false;
    const std::string_view word = scanner.word();
    if (word != "*") scanner.fail(fmt::format("{} is neither a number nor *", in_quotes(word)));
    return true;
}

/// Reads the next row; the rows' first index_columns numbers must be indices below the limit.
std::vector<double> read_row(TextScanner& scanner, int columns, int index_columns, int limit, const std::string& what,
                             Stars stars = Stars::refused) {
    const std::string expected = fmt::format("one of the {} numbers of {}", columns, what);
    std::vector<double> row;
    for (int column = 0; column < columns; ++column) {
        const bool may_be_star = stars == Stars::read_as_nan && column >= index_columns;
        if (may_be_star && pass_star(scanner)) {
            row.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        const double value = scanner.number(expected);
        if (may_be_star && std::isnan(value)) scanner.fail(fmt::format("{} holds a value that is no number", what));
        if (column < index_columns && !(value >= 0 && value < limit && value == std::floor(value))) {
            scanner.fail(fmt::format("{} of {} is not an index from 0 to {}", value, what, limit - 1));
        }
        row.push_back(value);
    }
    if (!scanner.at_line_end()) scanner.fail(fmt::format("{} has {} numbers, the line holds more", what, columns));
    return row;
}

}  // namespace

std::vector<std::vector<double>> read_rows(const std::filesystem::path& path, int columns, const std::string& what) {
    const std::string bytes = read_file(path);
    TextScanner scanner(bytes, path.string());
    std::vector<std::vector<double>> rows;
    while (scanner.next_line()) rows.push_back(read_row(scanner, columns, 0, 0, what));
    return rows;
}

std::vector<NumberRow> read_number_rows(const std::filesystem::path& path, int least, int most,
                                        const std::string& what) {
    const std::string bytes = read_file(path);
    TextScanner scanner(bytes, path.string());
    std::vector<NumberRow> rows;
    while (scanner.next_line()) {
        NumberRow& row = rows.emplace_back(NumberRow{scanner.line(), {}});
        while (!scanner.at_line_end() && static_cast<int>(row.numbers.size()) < most)
            row.numbers.push_back(scanner.number("a number of " + what));
        if (!scanner.at_line_end() || static_cast<int>(row.numbers.size()) < least)
            scanner.fail(least == most ? fmt::format("{} has {} numbers", what, least)
                                       : fmt::format("{} has {} to {} numbers", what, least, most));
    }
    return rows;
}

IndexedRows read_indexed_rows(const std::filesystem::path& path, int index_columns, int limit, int value_columns,
                              const std::string& what, Stars stars) {
    const std::string bytes = read_file(path);
    TextScanner scanner(bytes, path.string());
    std::vector<double> numbers;
    const int columns = index_columns + value_columns;
    while (scanner.next_line()) {
        const std::vector<double> row = read_row(scanner, columns, index_columns, limit, what, stars);
        numbers.insert(numbers.end(), row.begin(), row.end());
    }
    const Eigen::Index row_count = static_cast<Eigen::Index>(numbers.size()) / std::max(columns, 1);
    const Eigen::Map<const Positions> table(numbers.data(), row_count, columns);
    return {table.leftCols(index_columns).cast<int>(), table.rightCols(value_columns)};
}

}  // namespace beltrami
