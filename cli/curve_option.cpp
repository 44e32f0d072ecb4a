#include "curve_option.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <beltrami/base/error.h>

#include "landmark_options.h"
#include "place_file.h"
#include "words.h"

namespace beltrami::cli {

namespace {

/// A line of words.
struct Line {
    NumberRow row;
    std::vector<std::string> words;
};

std::vector<Line> read_lines(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw Error(Cause::unreadable, "cannot open " + path, "check the path and permissions");
    std::vector<Line> lines;
    std::string text;
    for (std::int64_t number = 1; std::getline(in, text); ++number) {
        std::istringstream words(text.substr(0, text.find('#')));
        Line line{{number, {}}, {}};
        for (std::string word; words >> word;) line.words.push_back(word);
        if (!line.words.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

void read_numbers(const std::string& path, Line& line) {
    for (const std::string& word : line.words) {
        char* end = nullptr;
        line.row.numbers.push_back(std::strtod(word.c_str(), &end));
        if (*end != '\0') fail_at_row(path, line.row, fmt::format("'{}' is no number", word));
    }
}

bool same_place(const MeshPoint& a, const MeshPoint& b) {
    return a.face == b.face && a.vertices == b.vertices && a.barycentric == b.barycentric;
}

/// A last point that is the first closes the curve.
void close_if_repeated(CurveThrough& curve) {
    if (curve.points.size() < 3 || !same_place(curve.points.front(), curve.points.back())) return;
    curve.points.pop_back();
    curve.closed = true;
}

}  // namespace

void CurveOption::add_to(CLI::App& app) {
    app.add_option(
           "--curves", path_,
           "curves of SOURCE and their partners on TARGET, joined by geodesics through given points: blocks "
           "`curve slide` or `curve fixed`, lines `source_vertex`, `onto`, as many lines `target_vertex` or `x y "
           "z`; the first point again at the end closes a curve")
        ->type_name("FILE");
}

std::vector<CurvePair> CurveOption::curves(const MeshInput& source, const MeshInput& target, Warnings& warnings) const {
    std::vector<CurvePair> result;
    if (path_.empty()) return result;
    bool onto = true;
    std::vector<int> far;
    for (Line& line : read_lines(path_)) {
        if (line.words[0] == "curve") {
            if (line.words.size() != 2 || (line.words[1] != "slide" && line.words[1] != "fixed"))
                fail_at_row(path_, line.row, "a curve begins with `curve slide` or `curve fixed`");
            if (!result.empty() && result.back().target.points.empty())
                fail_at_row(path_, line.row, "the curve before has no partner after `onto`");
            result.push_back({{}, {}, line.words[1] == "slide"});
            onto = false;
            continue;
        }
        if (result.empty()) fail_at_row(path_, line.row, "a curve begins with `curve slide` or `curve fixed`");
        if (line.words[0] == "onto" && line.words.size() == 1 && !onto) {
            onto = true;
            continue;
        }
        read_numbers(path_, line);
        if (!onto) {
            if (line.row.numbers.size() != 1)
                fail_at_row(path_, line.row, "a line before `onto` is the number of one vertex");
            const int vertex = source.number_of(index_at(path_, line.row, 0), "a point of a curve");
            result.back().source.points.push_back(place_of_vertex(source.mesh, vertex));
            continue;
        }
        const NearestPlace place = place_at(path_, line.row, 0, target);
        result.back().target.points.push_back(place.place);
        if (is_far(place, target)) far.push_back(static_cast<int>(line.row.line) - 1);
    }
    if (result.empty()) throw Error(Cause::unreadable, path_ + " has no curve", "begin one with `curve slide`");
    if (result.back().target.points.empty())
        throw Error(Cause::unreadable, path_ + ": the last curve has no partner", "add `onto` and its points");
    for (CurvePair& pair : result) {
        close_if_repeated(pair.source);
        close_if_repeated(pair.target);
    }
    if (!far.empty())
        warnings.push_back(
            {WarningKind::marks,
             fmt::format("{} of curves far from TARGET (more than 1 % of its diagonal), the first on line {}",
                         counted(far.size(), "point is", "points are"), far[0] + 1),
             {Things::lines, far}});
    return result;
}

}  // namespace beltrami::cli
