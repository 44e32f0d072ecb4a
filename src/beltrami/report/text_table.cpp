#include <beltrami/report/text_table.h>

#include <fmt/format.h>

#include <algorithm>

namespace beltrami {

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
    std::string table;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t column = 0; column < row.size(); ++column) {
            std::size_t width = 0;
            for (const auto& other : rows) width = std::max(width, other[column].size());
            const bool unused =
                std::all_of(rows.begin() + 1, rows.end(), [&](const auto& r) { return r[column].empty(); });
            if (unused) continue;
            line +=
                column == 0 ? fmt::format("{:<{}}", row[column], width) : fmt::format("  {:>{}}", row[column], width);
        }
        while (!line.empty() && line.back() == ' ') line.pop_back();
        table += line + "\n";
    }
    return table;
}

}  // namespace beltrami
