#include "boundary_options.h"

#include <cmath>
#include <optional>
#include <string_view>

#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>

#include "parse.h"

namespace beltrami::cli {

namespace {

constexpr std::string_view kPolygon = "polygon:";

}  // namespace

void BoundaryOptions::add_to(CLI::App& app, const std::string& also, const std::string& pins) {
    app.add_option(
           "--boundary", spec_,
           "where the outer boundary loop goes, counter-clockwise: disk or disk:A (angle t + A sin t, t = 2π · arc "
           "length / total), "
           "rectangle:W,H, polygon:FILE (a line `x y` per point)" +
               also)
        ->type_name("SPEC");
    app.add_option(
           "--corners", corners_,
           "four boundary vertices, counter-clockwise, that go to the rectangle's corners (0,0), (W,0), (W,H), (0,H)")
        ->delimiter(',')
        ->expected(4)
        ->type_name("a,b,c,d");
    app.add_option("--first-vertex,--start", start_,
                   "the boundary vertex that goes to angle 0, the first corner or the polygon's first point; default: "
                   "the smallest")
        ->type_name("V");
    app.add_option("--speed", speed_, "how fast the boundary runs along its target")
        ->check(CLI::IsMember({"arclength", "conformal"}))
        ->capture_default_str();
    app.add_option("--outer", outer_,
                   "the boundary loop, numbered as `beltrami info` prints it, whose image encloses the others; "
                   "--boundary is about this one")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->type_name("h");
    app.add_option("--hole", hole_specs_,
                   "the hole's loop h goes to the circle around x,y of radius r, clockwise by arc length, its smallest "
                   "vertex to the angle t (radians, 0 if absent); once for each hole")
        ->allow_extra_args(false)
        ->type_name("h=disk:x,y,r[,t]");
    app.add_option("--pin", pin_file_,
                   "prescribed vertices: a line `vertex x y` each, vertices counted from 0 in file order, # comments; "
                   "* for a coordinate that is free (vertices inside only)" +
                       pins)
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
        const auto amplitude = colon == std::string::npos ? std::vector<double>{0.0} : number_list(rest);
        if (!amplitude || amplitude->size() != 1)
            throw Error(Cause::bad_option, "--boundary " + spec_ + " is not disk or disk:A with a number A");
        sizes_ = *amplitude;
    } else if (kind == "rectangle") {
        target_ = Target::rectangle;
        const auto size = number_list(rest);
        if (!size || size->size() != 2)
            throw Error(Cause::bad_option, "--boundary " + spec_ + " is not rectangle:W,H with two numbers");
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

void BoundaryOptions::parse_holes() {
    constexpr std::string_view kDisk = "disk:";
    for (const std::string& spec : hole_specs_) {
        const auto parts = of_loop(spec);
        const auto numbers =
            parts && parts->second.starts_with(kDisk) ? number_list(parts->second.substr(kDisk.size())) : std::nullopt;
        if (!numbers || numbers->size() < 3 || numbers->size() > 4)
            throw Error(Cause::bad_option,
                        "--hole " + spec + " is not h=disk:x,y,r or h=disk:x,y,r,t with a loop h and numbers",
                        "`beltrami info` prints the loops' numbers");
        if (parts->first == outer_)
            throw Error(Cause::bad_option, "--hole " + spec + " names the outer loop",
                        "prescribe it with --boundary, or name another loop with --outer");
        for (const Circle& other : circles_)
            if (other.loop == parts->first)
                throw Error(Cause::bad_option, "--hole is given twice for loop " + std::to_string(other.loop));
        circles_.push_back(
            {parts->first, {(*numbers)[0], (*numbers)[1]}, (*numbers)[2], numbers->size() == 4 ? (*numbers)[3] : 0.0});
    }
}

void BoundaryOptions::read_pins(const MeshInput& source) {
    const IndexedRows rows = read_indexed_rows(pin_file_, 1, static_cast<int>(source.numbers.size()), 2,
                                               "a pinned vertex", Stars::read_as_nan);
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        const int vertex = source.number_of(rows.indices(i, 0), "a pinned one");
        const double x = rows.values(i, 0), y = rows.values(i, 1);
        if (std::isnan(x) && std::isnan(y))
            throw Error(Cause::bad_boundary,
                        pin_file_ + ": both coordinates of vertex " + std::to_string(vertex) + " are free",
                        "leave its line out", {Things::vertices, {vertex}});
        if (std::isnan(x)) {
            pins_.pin_to_line(vertex, Complex(0, y), 1.0);
        } else if (std::isnan(y)) {
            pins_.pin_to_line(vertex, x, Complex(0, 1));
        } else {
            pins_.pin(vertex, Complex(x, y));
        }
    }
}

void BoundaryOptions::load(const MeshInput& source) {
    if (!spec_.empty()) {
        parse_spec();
    } else if (!corners_.empty() || start_) {
        throw Error(Cause::bad_option, "--corners and --first-vertex say nothing without --boundary");
    }
    for (int& corner : corners_) corner = source.number_of(corner, "a corner");
    if (start_) start_ = source.number_of(*start_, "the first vertex of the boundary");
    parse_holes();
    if (!pin_file_.empty()) read_pins(source);
}

BoundaryCondition BoundaryOptions::outer_values(const Shape& shape) const {
    const Surface& source = shape.surface();
    const BoundaryPlacement placement{
        start_, speed_ == "conformal" ? BoundarySpeed::conformal : BoundarySpeed::arclength, outer_, &shape};
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

std::optional<TargetCurve> BoundaryOptions::curve(int loop) const {
    for (const Circle& circle : circles_)
        if (circle.loop == loop) return TargetCurve::circle(circle.centre, circle.radius);
    if (loop != outer_) return {};
    switch (target_) {
        case Target::none:
            return {};
        case Target::disk:
            return TargetCurve::circle(0, 1);
        case Target::rectangle:
            return TargetCurve::polygon({0, sizes_[0], {sizes_[0], sizes_[1]}, {0, sizes_[1]}});
        case Target::polygon:
            return TargetCurve::polygon(polygon_);
    }
    return {};
}

BoundaryCondition BoundaryOptions::values(const Shape& shape) const {
    const Surface& source = shape.surface();
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (outer_ > 0 && outer_ >= loops)
        throw Error(Cause::bad_option, "--outer " + std::to_string(outer_) + ": there is no such boundary loop",
                    "`beltrami info` prints the loops' numbers");
    BoundaryCondition boundary = outer_values(shape);
    const auto add = [&](const BoundaryCondition& more) {
        for (std::size_t i = 0; i < more.vertices.size(); ++i) boundary.pin(more.vertices[i], more.images[i]);
    };
    for (const Circle& circle : circles_)
        add(hole_to_circle(source, circle.loop, circle.centre, circle.radius, circle.start_angle));
    add(pins_);
    boundary.lines = pins_.lines;
    validate(boundary, source);
    return boundary;
}

}  // namespace beltrami::cli
