#pragma once

#include <CLI/CLI.hpp>

#include <optional>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/shape.h>
#include <beltrami/plane/target_curve.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// --boundary, --corners, --first-vertex, --speed, --outer, --hole, --pin: what the user prescribes about the boundary.
class BoundaryOptions {
  public:
    /// @param also what --boundary may say beside curves, and @p pins what lines of --pin may be beside them
    void add_to(CLI::App& app, const std::string& also = {}, const std::string& pins = {});
    /// The files the options name.
    std::vector<NamedFile> inputs() const;
    /// Reads the options and their files; vertices are then numbered as in the mesh. @throw Error bad_option,
    /// unreadable, bad_boundary
    void load(const MeshInput& source);
    /// What is prescribed. @pre load() @throw Error bad_option, bad_boundary
    BoundaryCondition values(const Surface& source) const { return values(Shape(source)); }
    /// The same with a chart of the shape for the conformal speed.
    BoundaryCondition values(const Shape& shape) const;
    /// The curve along which the values of a loop lie; nothing where none is given by --boundary or --hole.
    std::optional<TargetCurve> curve(int loop) const;
    /// --boundary and --pin as they were given.
    const std::string& spec() const { return spec_; }
    const std::string& pin_file() const { return pin_file_; }
    /// The loop whose image encloses the others.
    int outer_loop() const { return outer_; }
    /// Whether vertices or loops are named, which only one component has.
    bool names_vertices() const { return !hole_specs_.empty() || !pin_file_.empty() || !corners_.empty() || start_; }
    /// Whether anything but the outer loop is given.
    bool given() const {
        return !spec_.empty() || !hole_specs_.empty() || !pin_file_.empty() || !corners_.empty() || start_;
    }

  private:
    enum class Target { none, disk, rectangle, polygon };
    /// --hole: a loop's circle.
    struct Circle {
        int loop;
        Complex centre;
        double radius, start_angle;
    };

    void parse_spec();
    void parse_holes();
    void read_pins(const MeshInput& source);
    /// Of polygon:FILE.
    std::string polygon_file() const;
    BoundaryCondition outer_values(const Shape& shape) const;

    std::string spec_, speed_ = "arclength", pin_file_;
    std::vector<std::string> hole_specs_;
    std::vector<int> corners_;
    std::optional<int> start_;
    int outer_ = 0;

    Target target_ = Target::none;
    std::vector<double> sizes_;     // amplitude of a disk; width and height of a rectangle
    std::vector<Complex> polygon_;  // points
    std::vector<Circle> circles_;
    BoundaryCondition pins_;
};

}  // namespace beltrami::cli
