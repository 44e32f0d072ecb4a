#include "boundary_options.h"

#include <charconv>
#include <optional>
#include <string_view>

#include <beltrami/io/number_lists.h>
#include <beltrami/mesh/error.h>

namespace beltrami::cli {

namespace {

constexpr std::string_view kPolygon = "polygon:";

/// The numbers of "a,b,…"; nothing if it is not a list of exactly so many.
std::optional<std::vector<double>> numbers(std::string_view text, std::size_t count) {
    std::vector<double> values;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view word = text.substr(0, comma);
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) return {};
        values.push_back(value);
        if (comma == std::string_view::npos) break;
        text.remove_prefix(comma + 1);
    }
    if (values.size() != count) return {};
    return values;
}

}  // namespace

void BoundaryOptions::add_to(CLI::App& app) {
    app.add_option("--boundary", spec_,
                   "where the outer boundary goes, counter-clockwise: disk or disk:A (angle t + A sin t, t = 2π · arc "
                   "length / total), "
                   "rectangle:W,H, polygon:FILE (a line `x y` per point)")
        ->type_name("SPEC");
    app.add_option(
           "--corners", corners_,
           "four boundary vertices, counter-clockwise, that go to the rectangle's corners (0,0), (W,0), (W,H), (0,H)")
        ->delimiter(',')
        ->expected(4)
        ->type_name("a,b,c,d");
    app.add_option("--start", start_,
                   "the boundary vertex that goes to angle 0, the first corner or the polygon's first point; default: "
                   "the smallest")
        ->type_name("V");
    app.add_option("--speed", speed_, "how fast the boundary runs along its target")
        ->check(CLI::IsMember({"arclength", "conformal"}))
        ->capture_default_str();
    app.add_option("--pin", pin_file_,
                   "prescribed vertices: a line `vertex x y` each, vertices counted from 0 in file order, # comments")
        ->type_name("FILE");
}

std::string BoundaryOptions::polygon_file() const {
    return spec_.starts_with(kPolygon) ? spec_.substr(kPolygon.size()) : "";
}

std::vector<NamedFile> BoundaryOptions::inputs() const {
    return {{"--boundary", polygon_file()}, {"--pin", pin_file_}};
}

void BoundaryOptions::parse_spec() {
    const std::size_t colon = spec_.find(':');
    const std::string kind = spec_.substr(0, colon), rest = colon == std::string::npos ? "" : spec_.substr(colon + 1);
    if (!corners_.empty() && kind != "rectangle")
        throw Error(Cause::bad_option, "--corners belongs to --boundary rectangle:W,H");
    if (kind == "disk") {
        target_ = Target::disk;
        const auto amplitude = colon == std::string::npos ? std::vector<double>{0.0} : numbers(rest, 1);
        if (!amplitude)
            throw Error(Cause::bad_option, "--boundary " + spec_ + " is not disk or disk:A with a number A");
        sizes_ = *amplitude;
    } else if (kind == "rectangle") {
        target_ = Target::rectangle;
        const auto size = numbers(rest, 2);
        if (!size) throw Error(Cause::bad_option, "--boundary " + spec_ + " is not rectangle:W,H with two numbers");
        sizes_ = *size;
    } else if (!polygon_file().empty()) {
        target_ = Target::polygon;
        for (const auto& row : read_rows(polygon_file(), 2, "a point of the polygon"))
            polygon_.emplace_back(row[0], row[1]);
    } else {
        throw Error(Cause::bad_option, "--boundary " + spec_ + " is not known",
                    "give disk, disk:A, rectangle:W,H or polygon:FILE");
    }
}

void BoundaryOptions::load(const Mesh& source) {
    if (!spec_.empty()) {
        parse_spec();
    } else if (!corners_.empty() || start_) {
        throw Error(Cause::bad_option, "--corners and --start say nothing without --boundary");
    }
    if (pin_file_.empty()) return;
    const IndexedRows rows = read_indexed_rows(pin_file_, 1, source.vertex_count(), 2, "a pinned vertex");
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
        pins_.pin(rows.indices(i, 0), Complex(rows.values(i, 0), rows.values(i, 1)));
}

BoundaryCondition BoundaryOptions::outer_loop(const Surface& source) const {
    const BoundaryPlacement placement{start_,
                                      speed_ == "conformal" ? BoundarySpeed::conformal : BoundarySpeed::arclength};
    switch (target_) {
        case Target::none:
            return {};
        case Target::disk:
            return boundary_to_disk(source, sizes_[0], placement);
        case Target::rectangle: {
            std::optional<std::array<int, 4>> corners;
            if (!corners_.empty()) corners = {corners_[0], corners_[1], corners_[2], corners_[3]};
            return boundary_to_rectangle(source, sizes_[0], sizes_[1], corners, placement);
        }
        case Target::polygon:
            return boundary_to_polygon(source, polygon_, placement);
    }
    return {};
}

BoundaryCondition BoundaryOptions::values(const Surface& source) const {
    BoundaryCondition boundary = outer_loop(source);
    for (std::size_t i = 0; i < pins_.vertices.size(); ++i) boundary.pin(pins_.vertices[i], pins_.images[i]);
    validate(boundary, source);
    return boundary;
}

}  // namespace beltrami::cli
