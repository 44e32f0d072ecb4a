#include "hints.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace beltrami::cli {

namespace {

struct ErrorHint {
    Cause cause;
    Things of;
    const char* words;
};

constexpr std::array kErrorHints{
    ErrorHint{Cause::bad_option, Things::loops, "`beltrami info` prints the numbers of the loops"},
    ErrorHint{Cause::bad_boundary, Things::loops, "`beltrami info` prints the numbers of the loops"},
};

struct WarningHint {
    const char* command;
    WarningKind kind;
    const char* words;
};

constexpr std::array kWarningHints{
    WarningHint{"map", WarningKind::corner, "--speed conformal is gentler along the boundary than arc length"},
    WarningHint{"map", WarningKind::iteration_limit, "--max-iterations N allows more iterations"},
    WarningHint{"map", WarningKind::free_boundary,
                "--boundary, --hole and --pin prescribe more; --minimize max says that this map is meant"},
    WarningHint{"flow", WarningKind::free_boundary, "--boundary, --hole and --pin prescribe more"},
};

}  // namespace

std::string hint(const Error& error) {
    if (std::string_view(error.what()).find("give a start map") != std::string_view::npos)
        return "--start-map FILE reads one";
    const auto* found = std::find_if(kErrorHints.begin(), kErrorHints.end(), [&](const ErrorHint& row) {
        return row.cause == error.cause() && row.of == error.where().of;
    });
    return found == kErrorHints.end() ? "" : found->words;
}

std::vector<std::string> hints(const Record& record) {
    std::vector<std::string> result;
    for (const WarningHint& row : kWarningHints)
        if (row.command == record.command &&
            std::any_of(record.warnings.begin(), record.warnings.end(),
                        [&](const Warning& warning) { return warning.kind == row.kind; }))
            result.emplace_back(row.words);
    if (const auto& noise = record.outline.noise)
        result.push_back(fmt::format("--slack {:g} lets the points move so far", noise->slack));
    return result;
}

}  // namespace beltrami::cli
