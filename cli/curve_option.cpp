#include "curve_option.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/locate/point_at.h>

#include "landmark_options.h"
#include "place_file.h"

namespace beltrami::cli {

namespace {

constexpr double kFar = 0.01, kLeaves = 0.1;  // of the target's size: hardly meant to be on it, and certainly not
constexpr double kSamePoint = 1e-9;           // of the next point's distance

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

/// A last point that is the first, on both sides, closes the curve.
void close_if_repeated(CurveOnto& curve) {
    std::vector<MeshPoint>& here = curve.source.points;
    Target::Points& there = curve.target;
    const bool closed = here.size() > 2 && same_place(here.front(), here.back()),
               closed_there = there.size() > 2 && (there.front().position - there.back().position).norm() <
                                                      kSamePoint * (there.front().position - there[1].position).norm();
    if (closed != closed_there)
        throw Error(Cause::bad_boundary,
                    closed ? "a curve is closed and its partner is not" : "a curve is open and its partner is closed",
                    "give the first point again at the end of both, or of neither");
    if (!closed) return;
    here.pop_back();
    there.pop_back();
    curve.source.closed = true;
}

double diagonal_of(const Positions& points) {
    return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
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

std::vector<CurveOnto> CurveOption::read(const MeshInput& source, const PlaceOf& place_of, Warnings& warnings) const {
    std::vector<CurveOnto> result;
    bool onto = true;
    std::vector<int> far;
    for (Line& line : read_lines(path_)) {
        if (line.words[0] == "curve") {
            if (line.words.size() != 2 || (line.words[1] != "slide" && line.words[1] != "fixed"))
                fail_at_row(path_, line.row, "a curve begins with `curve slide` or `curve fixed`");
            if (!result.empty() && result.back().target.empty())
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
        const auto [point, off] = place_of(line.row);
        if (off > kLeaves)
            fail_at_row(path_, line.row,
                        fmt::format("the curve leaves TARGET: this point is {:.3g} % of its diagonal away", 100 * off),
                        Cause::bad_boundary, "give points of the surface, in its coordinates");
        if (off > kFar) far.push_back(static_cast<int>(line.row.line) - 1);
        result.back().target.push_back(point);
    }
    if (result.empty()) throw Error(Cause::unreadable, path_ + " has no curve", "begin one with `curve slide`");
    if (result.back().target.empty())
        throw Error(Cause::unreadable, path_ + ": the last curve has no partner", "add `onto` and its points");
    for (CurveOnto& curve : result) close_if_repeated(curve);
    if (!far.empty())
        warnings.push_back(
            {WarningKind::marks,
             fmt::format("{} of curves far from TARGET (more than 1 % of its diagonal), the first on line {}",
                         counted(far.size(), "point is", "points are"), far[0] + 1),
             {Things::lines, far}});
    return result;
}

std::vector<CurveOnto> CurveOption::curves(const MeshInput& source, const MeshInput& target, Warnings& warnings) const {
    if (path_.empty()) return {};
    const double diagonal = diagonal_of(target.mesh.positions);
    return read(
        source,
        [&](const NumberRow& row) {
            const NearestPlace found = place_at(path_, row, 0, target);
            Target::Point point;
            point.place = found.place;
            point.position = point_at(target.mesh, found.place);
            return std::pair(point, found.distance / (diagonal * target.unit));
        },
        warnings);
}

std::vector<CurveOnto> CurveOption::curves(const MeshInput& source, const Target& target, Warnings& warnings) const {
    if (path_.empty()) return {};
    return read(
        source,
        [&](const NumberRow& row) {
            if (row.numbers.size() != 3)
                fail_at_row(path_, row, "a point of TARGET, which has no vertices, is given as `x y z`");
            const Eigen::Vector3d given(row.numbers[0], row.numbers[1], row.numbers[2]);
            if (!given.allFinite()) fail_at_row(path_, row, "a coordinate is not finite");
            const Target::Point point = target.nearest(given);
            return std::pair(point, (point.position - given).norm() / (2 * std::max(1e-300, point.position.norm())));
        },
        warnings);
}

std::vector<CurvePair> CurveOption::pairs(const MeshInput& source, const MeshInput& target, Warnings& warnings) const {
    std::vector<CurvePair> result;
    for (const CurveOnto& curve : curves(source, target, warnings)) {
        CurvePair pair{curve.source, {{}, curve.source.closed}, curve.slides};
        for (const Target::Point& point : curve.target) pair.target.points.push_back(point.place);
        result.push_back(std::move(pair));
    }
    return result;
}

}  // namespace beltrami::cli
