#include "marking_options.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <beltrami/base/error.h>

#include "place_file.h"

namespace beltrami::cli {

namespace {

constexpr int kLongestRow = 1 << 20;

/// A path of vertices, as many a line as one likes.
std::vector<int> read_path(const std::string& path, const MeshInput& mesh) {
    std::vector<int> vertices;
    for (const NumberRow& row : read_number_rows(path, 1, kLongestRow, "vertices of a path"))
        for (const double number : row.numbers) {
            if (!(number >= 0 && number <= std::numeric_limits<int>::max() && number == std::floor(number)))
                fail_at_row(path, row, fmt::format("{} is not the number of a vertex", number));
            vertices.push_back(mesh.number_of(static_cast<int>(number), "on a path"));
        }
    if (vertices.size() < 3)
        throw Error(Cause::unreadable, fmt::format("{}: a closed path has three vertices or more", path),
                    "list its vertices in their order, the first one once");
    return vertices;
}

/// n:FILE.
std::pair<int, std::string> split_twist(const std::string& text) {
    const std::size_t colon = text.find(':');
    int turns = 0;
    const char* const end = text.data() + std::min(colon, text.size());
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [read, error] = std::from_chars(begin, end, turns);
    if (colon == std::string::npos || error != std::errc() || read != end || turns == 0)
        throw Error(Cause::bad_option, fmt::format("--twist {}: n:FILE is wanted, n a whole number other than 0", text),
                    "as in --twist 1:loop.txt");
    return {turns, text.substr(colon + 1)};
}

}  // namespace

CLI::Option* add_align_option(CLI::App& app, std::string& align) {
    return app
        .add_option("--align", align, "of surfaces with handles: lay SOURCE on TARGET before nearest points are taken")
        ->check(CLI::IsMember({"none", "rigid", "similarity"}))
        ->capture_default_str();
}

CLI::Option* add_marking_option(CLI::App& app, std::string& marking) {
    return app
        .add_option("--marking", marking,
                    "of surfaces with handles: the class of maps that take vertices to the nearest points, or search: "
                    "of tori that of least dilatation, of closed surfaces of higher genus that of least energy from "
                    "several starts")
        ->check(CLI::IsMember({"closest", "search"}));
}

Alignment alignment_of(const std::string& align) {
    if (align == "rigid") return Alignment::rigid;
    return align == "similarity" ? Alignment::similarity : Alignment::none;
}

void MarkingOptions::add_to(CLI::App& app) {
    app_ = &app;
    add_align_option(app, align_);
    add_marking_option(app, marking_)->capture_default_str();
    app.add_option(
           "--loop", loops_,
           "of closed surfaces with handles: a closed path of vertices of SOURCE and its image on TARGET, a file "
           "each; twice the genus of them, all through one vertex, as `uniformize --loops` writes them")
        ->type_name("FILE FILE");
    app.add_option(
           "--twist", twists_,
           "of closed surfaces with handles: n Dehn twists, to the left if n > 0, about a simple closed path of "
           "vertices of SOURCE; may be repeated")
        ->type_name("n:FILE");
}

std::vector<NamedFile> MarkingOptions::inputs() const {
    std::vector<NamedFile> files;
    for (const auto& [source, target] : loops_) files.insert(files.end(), {{"--loop", source}, {"--loop", target}});
    for (const std::string& twist : twists_) files.push_back({"--twist", split_twist(twist).second});
    return files;
}

std::string MarkingOptions::given() const {
    for (const char* name : {"--align", "--marking", "--loop", "--twist"})
        if (app_->count(name) > 0) return name;
    return {};
}

Alignment MarkingOptions::alignment() const {
    return alignment_of(align_);
}

HandleMarking MarkingOptions::load(const MeshInput& source, const MeshInput& target) const {
    HandleMarking marking;
    if (searches()) marking.search.emplace();
    marking.alignment = alignment();
    for (const auto& [of_source, of_target] : loops_) {
        marking.paths.push_back(read_path(of_source, source));
        marking.images.push_back(read_path(of_target, target));
    }
    for (const std::string& twist : twists_) {
        const auto [turns, path] = split_twist(twist);
        marking.twists.push_back({read_path(path, source), turns});
    }
    return marking;
}

}  // namespace beltrami::cli
