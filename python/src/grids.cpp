#include <beltrami/applications/conformal_carrier.h>
#include <beltrami/applications/fitting_grid.h>
#include <beltrami/applications/grid_on_surface.h>
#include <beltrami/report/grid_record.h>
#include <beltrami/report/record_json.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// Not the variant itself, which the binding would take for one of its kinds.
struct PlaneGridObject {
    PlaneGrid grid;
};

struct GridObject {
    SurfaceGrid grid;
    SurfacePtr surface;
    GridLines lines;
};

GridOptions grid_options(const py::kwargs& given) {
    GridOptions options;
    Keywords keywords(given);
    keywords.choose<GridOptions::Border>(
        "border", options.border,
        {{"trimmed", GridOptions::Border::trimmed}, {"stepped", GridOptions::Border::stepped}});
    keywords.take("snap", options.snap);
    keywords.finish();
    return options;
}

GridLines lines_from(const std::string& word) {
    return Keywords::choice<GridLines>("lines", py::str(word),
                                       {{"automatic", GridLines::automatic},
                                        {"rectangular", GridLines::rectangular},
                                        {"polar", GridLines::polar},
                                        {"log_polar", GridLines::log_polar}});
}

}  // namespace

void bind_grids(py::module_& m) {
    py::class_<PlaneGridObject>(m, "PlaneGrid", "Lines in the plane: rectangular, polar or log-polar.")
        .def_static(
            "rectangular",
            [](double spacing, double spacing_up, Complex origin, double angle) {
                return PlaneGridObject{RectangularGrid{spacing, spacing_up, origin, angle}};
            },
            py::arg("spacing"), py::arg("spacing_up") = 0.0, py::arg("origin") = Complex(0), py::arg("angle") = 0.0,
            "Lines in two directions; angle in radians from the real axis, spacing_up=0: the same.")
        .def_static(
            "polar",
            [](Complex centre, double spacing, int sectors, double angle) {
                return PlaneGridObject{PolarGrid{centre, spacing, sectors, angle}};
            },
            py::arg("centre"), py::arg("spacing"), py::arg("sectors") = 32, py::arg("angle") = 0.0,
            "Circles of equal distance around a centre, and rays.")
        .def_static(
            "log_polar",
            [](Complex centre, double inner_radius, double outer_radius, int sectors, double angle) {
                return PlaneGridObject{LogPolarGrid{centre, inner_radius, outer_radius, sectors, angle}};
            },
            py::arg("centre"), py::arg("inner_radius"), py::arg("outer_radius") = 0.0, py::arg("sectors") = 32,
            py::arg("angle") = 0.0, "Circles whose radii grow by one factor, and rays: conformally a square grid.")
        .def("__repr__", [](const PlaneGridObject& o) {
            return std::string("<beltrami.PlaneGrid: ") + to_string(lines_of(o.grid)) + ">";
        });
    m.def(
        "fitting_grid",
        [](const TargetDomain& domain, int cells, const std::string& lines) {
            return PlaneGridObject{fitting_grid(domain, cells, lines_from(lines))};
        },
        py::arg("domain"), py::arg("cells"), py::arg("lines") = "automatic",
        "A grid that fits a domain, cells along its longer side, or around.\n\nlines: \"automatic\", \"rectangular\", "
        "\"polar\" or \"log_polar\".\n\nRaises BadOption.");

    py::class_<GridObject>(m, "SurfaceGrid", "A grid of the plane carried to a surface.")
        .def_property_readonly(
            "mesh", [](const GridObject& o) { return o.grid.mesh; }, "Quads, and triangles at its border")
        .def_property_readonly(
            "places", [](const GridObject& o) { return Places{o.grid.parents}; }, "#V on the surface")
        .def_property_readonly(
            "parameter",
            [](const py::object& self) { return view(self.cast<const GridObject&>().grid.parameter, self); },
            "#V complex places in the plane")
        .def_property_readonly("on_border", [](const GridObject& o) { return flag_array(o.grid.on_border); })
        .def_property_readonly(
            "cells", [](const GridObject& o) { return pairs_array(o.grid.cells); }, "#F×2 column and row")
        .def_property_readonly("whole_cells", [](const GridObject& o) { return o.grid.whole_cells; })
        .def_property_readonly("trimmed_cells", [](const GridObject& o) { return o.grid.trimmed_cells; })
        .def_property_readonly("omitted_cells", [](const GridObject& o) { return o.grid.omitted_cells; })
        .def_property_readonly(
            "min_angle", [](const GridObject& o) { return o.grid.quality.min_angle; }, "Radians")
        .def_property_readonly(
            "mean_skew", [](const GridObject& o) { return o.grid.quality.mean_skew; }, "Radians")
        .def_property_readonly("folded", [](const GridObject& o) { return index_array(o.grid.quality.folded); })
        .def(
            "to_json",
            [](const GridObject& o) {
                Record record;
                record.command = "grid";
                record.source = source_record(o.surface->surface);
                record.grid = grid_record(o.grid, o.surface->surface.mesh);
                record.grid->lines = o.lines;
                return to_json(record);
            },
            "The record as JSON (docs/json.md).")
        .def("__repr__", [](const GridObject& o) {
            return "<beltrami.SurfaceGrid: " + std::to_string(o.grid.mesh.face_count()) + " faces, " +
                   std::to_string(o.grid.quality.folded.size()) + " folded>";
        });
    m.def(
        "grid_on_surface",
        [](const SurfacePtr& surface, const py::object& map, const PlaneGridObject& grid, const py::kwargs& given) {
            const GridOptions options = grid_options(given);
            const Eigen::VectorXcd images = map_of(*surface, map);
            return without_lock([&] {
                return GridObject{grid_on_surface(surface->surface, images, grid.grid, options), surface,
                                  lines_of(grid.grid)};
            });
        },
        py::arg("surface"), py::arg("map"), py::arg("grid"),
        "Carries a grid in the plane back to a surface by the inverse of a one-to-one map (Ng, Gu & Lui 2014, figure "
        "22).\n\nmap: #V images. Options: border=\"trimmed\" | \"stepped\", snap=0.25 (of an edge).\n\nRaises "
        "BadOption, "
        "BadMesh naming faces that the map flips.");
    m.def(
        "conformal_carrier",
        [](const SurfacePtr& surface, int outer_loop) {
            require_loop(*surface, outer_loop);
            ConformalCarrier carrier = without_lock([&] { return conformal_carrier(surface->surface, outer_loop); });
            SurfacePtr mapped = carrier.split ? make_surface(carrier.split->mesh, carrier.split->metric) : surface;
            return py::make_tuple(std::move(mapped), std::move(carrier.map), std::move(carrier.domain));
        },
        py::arg("surface"), py::arg("outer_loop") = 0,
        "A conformal map to a domain that the surface alone determines, to carry a grid from there: the surface that "
        "was "
        "mapped, the map (#V) and the domain.\n\nRaises BadMesh, BadBoundary, NotSolved.");
}

}  // namespace beltrami::python
