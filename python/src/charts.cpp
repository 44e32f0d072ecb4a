#include <beltrami/charts/circle_matching.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/charts/uniformization.h>
#include <beltrami/uniformize/flatten.h>
#include <beltrami/uniformize/fold_free_flattening.h>

#include "charts.h"
#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

py::tuple hole_tuple(const RoundHole& hole) {
    return py::make_tuple(hole.loop, hole.centre, hole.radius);
}

RoundHole hole_from(const py::handle& object) {
    constexpr const char* kWanted = "a hole is (loop, centre, radius) or (centre, radius)";
    const auto tuple = value_of<py::tuple>(object, kWanted);
    if (tuple.size() != 2 && tuple.size() != 3) throw py::type_error(kWanted);
    const std::size_t first = tuple.size() - 2;
    RoundHole hole;
    if (first == 1) hole.loop = value_of<int>(tuple[0], kWanted);
    hole.centre = value_of<Complex>(tuple[first], kWanted);
    hole.radius = value_of<double>(tuple[first + 1], kWanted);
    if (!(hole.radius > 0 && std::abs(hole.centre) + hole.radius < 1))
        throw Error(Cause::bad_option, "a hole does not lie within the unit disk");
    return hole;
}

namespace {

py::list hole_list(const std::vector<RoundHole>& holes) {
    py::list list;
    for (const RoundHole& hole : holes) list.append(hole_tuple(hole));
    return list;
}

std::vector<RoundHole> holes_from(const py::object& object) {
    if (!py::isinstance<py::iterable>(object)) throw py::type_error("holes are a list of (loop, centre, radius)");
    std::vector<RoundHole> holes;
    for (const py::handle item : object) holes.push_back(hole_from(item));
    return holes;
}

/// A conformal map of a surface to its canonical domain.
class ConformalObject final : public PlanarMap {
  public:
    ConformalObject(const SurfacePtr& surface, std::string method, Eigen::VectorXcd map, Warnings warnings)
        : PlanarMap(surface, surface),
          method_(std::move(method)),
          map_(std::move(map)),
          distortion_(beltrami::distortion(surface->surface.operators, map_)),
          warnings_(std::move(warnings)) {}
    const Eigen::VectorXcd& map() const override { return map_; }
    const Distortion& distortion() const override { return distortion_; }
    const Warnings& warnings() const override { return warnings_; }
    std::string method() const override { return method_; }
    Record record() const override { return record_of(*this, "uniformize"); }

    std::vector<RoundHole> holes;
    std::vector<double> moduli;
    std::optional<double> module;
    Eigen::VectorXd log_scale;
    double residual = 0;

  private:
    std::string method_;
    Eigen::VectorXcd map_;
    Distortion distortion_;
    Warnings warnings_;
};
using ConformalPtr = std::shared_ptr<ConformalObject>;

ConformalPtr uniformized(const SurfacePtr& surface, int outer_loop, const std::optional<int>& centre) {
    require_loop(*surface, outer_loop);
    return without_lock([&] {
        Uniformization found =
            uniformization(surface->surface, CircleDomainChart(surface->shape.circles(outer_loop)), centre);
        auto object = std::make_shared<ConformalObject>(surface, "uniformization", std::move(found.map),
                                                        std::move(found.chart.chart.warnings));
        object->holes = std::move(found.holes);
        object->moduli = std::move(found.moduli);
        object->module = found.module;
        return object;
    });
}

ConformalPtr circles(const SurfacePtr& surface, int outer_loop) {
    require_loop(*surface, outer_loop);
    return without_lock([&] {
        const CircleDomainChart& chart = surface->shape.circles(outer_loop);
        auto object =
            std::make_shared<ConformalObject>(surface, "circle domain", chart.chart.vertices, chart.chart.warnings);
        object->holes = chart.holes;
        return object;
    });
}

ConformalPtr disk_chart(const SurfacePtr& surface) {
    return without_lock([&] {
        Chart chart = round_disk_chart(surface->surface);
        return std::make_shared<ConformalObject>(surface, "round disk", std::move(chart.vertices),
                                                 std::move(chart.warnings));
    });
}

ConformalPtr in_plane(const SurfacePtr& surface) {
    require_genus_zero(surface->surface);
    if (!surface->surface.in_plane()) throw Error(Cause::bad_mesh, "the surface does not lie in the plane");
    return without_lock([&] {
        Chart chart = plane_chart(surface->surface);
        return std::make_shared<ConformalObject>(surface, "plane chart", std::move(chart.vertices),
                                                 std::move(chart.warnings));
    });
}

ConformalPtr domain(const SurfacePtr& surface, int outer_loop) {
    require_loop(*surface, outer_loop);
    return without_lock([&] {
        const Chart& chart = surface->shape.chart(outer_loop);
        return std::make_shared<ConformalObject>(surface, "domain chart", chart.vertices, chart.warnings);
    });
}

FlattenOptions flatten_options(const py::object& angles, double tolerance, int max_iterations) {
    FlattenOptions options;
    options.tolerance = tolerance;
    options.max_iterations = max_iterations;
    if (!angles.is_none()) {
        const Eigen::VectorXd list = real_numbers(angles, "boundary_angles");
        options.boundary_angles.assign(list.begin(), list.end());
        if (list.size() == 0) throw Error(Cause::bad_option, "boundary_angles are empty");
    }
    return options;
}

ConformalPtr object_of(const SurfacePtr& surface, const char* method, Flattening flat) {
    auto object = std::make_shared<ConformalObject>(surface, method, std::move(flat.positions), Warnings());
    object->log_scale = std::move(flat.log_scale);
    object->residual = flat.residual;
    return object;
}

ConformalPtr flattened(const SurfacePtr& surface, const py::object& angles, double tolerance, int max_iterations) {
    const FlattenOptions options = flatten_options(angles, tolerance, max_iterations);
    return without_lock([&] {
        const Surface& source = surface->surface;
        return object_of(surface, "flatten",
                         source.metric ? flatten(source.mesh, *source.metric, options) : flatten(source.mesh, options));
    });
}

py::tuple fold_free(const SurfacePtr& surface, const py::object& angles, double tolerance, int max_iterations) {
    const FlattenOptions options = flatten_options(angles, tolerance, max_iterations);
    FoldFreeFlattening found = without_lock([&] { return fold_free_flattening(surface->surface, options); });
    const bool fold_free = found.fold_free;
    return py::make_tuple(object_of(surface, "flatten", std::move(found.flattening)), fold_free,
                          index_array(found.unfolded));
}

}  // namespace

void bind_charts(py::module_& m) {
    py::class_<ConformalObject, PlanarMap, ConformalPtr>(m, "ConformalMap", "A conformal map to a canonical domain.")
        .def_property_readonly(
            "holes", [](const ConformalObject& o) { return hole_list(o.holes); },
            "(loop, centre, radius) of every round hole")
        .def_property_readonly(
            "moduli", [](const ConformalObject& o) { return o.moduli; },
            "Of uniformization: the 3n − 3 moduli of n ≥ 2 holes, of one hole its radius")
        .def_property_readonly(
            "module", [](const ConformalObject& o) { return o.module; }, "Of a ring: log(1/r)/2π, the conformal module")
        .def_property_readonly(
            "log_scale",
            [](const py::object& self) { return view(self.cast<const ConformalObject&>().log_scale, self); },
            "Of flatten: #V log of the scale factor, lengths become l e^{(u_i+u_j)/2}; else empty")
        .def_property_readonly(
            "residual", [](const ConformalObject& o) { return o.residual; },
            "Of flatten: largest angle defect left, radians");
    m.def(
        "flatten", &flattened, py::arg("surface"), py::arg("boundary_angles") = py::none(), py::kw_only(),
        py::arg("tolerance") = 1e-10, py::arg("max_iterations") = 100,
        "Flattens a disk by discrete conformal equivalence, in its units.\n\nboundary_angles: interior angles of the "
        "image polygon (radians), one per vertex of boundary loop 0, summing to (n − 2)π; None: the natural boundary, "
        "which keeps lengths.\n\nRaises BadOption, BadBoundary, BadMesh, NotSolved. Source: Springborn, Schröder, "
        "Pinkall 2008; Gillespie, Springborn, Crane 2021.");
    m.def("fold_free_flattening", &fold_free, py::arg("surface"), py::arg("boundary_angles") = py::none(),
          py::kw_only(), py::arg("tolerance") = 1e-10, py::arg("max_iterations") = 100,
          "flatten, and where edges that were flipped on the way leave faces flipped, the nearest map without "
          "folds.\n\nReturns the ConformalMap, whether it is free of folds, and the faces that had come out flipped. "
          "Raises as flatten.");
    m.def(
        "plane_chart", &in_plane, py::arg("surface"),
        "The coordinates of a planar surface, moved and scaled into the unit disk.\n\nRaises BadMesh unless it lies in "
        "the plane, one component of genus 0 with a boundary.");
    m.def(
        "require_disk", [](const SurfacePtr& surface) { require_disk(surface->surface); }, py::arg("surface"),
        "Raises BadMesh unless the surface is a disk: one component, one boundary loop, genus 0.");
    m.def(
        "require_open_component", [](const SurfacePtr& surface) { require_open_component(surface->surface); },
        py::arg("surface"), "Raises BadMesh unless the surface has one component and a boundary, whatever its genus.");
    m.def(
        "require_genus_zero", [](const SurfacePtr& surface) { require_genus_zero(surface->surface); },
        py::arg("surface"), "Raises BadMesh unless the surface has one component, genus 0 and a boundary.");
    m.def("uniformization", &uniformized, py::arg("surface"), py::arg("outer_loop") = 0, py::arg("centre") = py::none(),
          "The conformal map to the round disk, or to the disk less round holes, normalised so that it is unique: with "
          "holes, that of loop centre goes around 0 (None: the first). Moduli and the module of a ring come along.\n\n"
          "Raises BadOption, BadMesh, NotSolved.");
    m.def("circle_domain_chart", &circles, py::arg("surface"), py::arg("outer_loop") = 0,
          "The conformal map to the unit disk with round holes, kept by the surface.\n\nRaises BadMesh, NotSolved.");
    m.def("domain_chart", &domain, py::arg("surface"), py::arg("outer_loop") = 0,
          "The conformal map to the unit disk with holes of whatever shape, kept by the surface.\n\nRaises BadMesh, "
          "NotSolved.");
    m.def("round_disk_chart", &disk_chart, py::arg("surface"),
          "The conformal map of a disk to the round unit disk, its area centred at 0.\n\nRaises BadMesh, NotSolved.");
    m.def(
        "match_circle_domains",
        [](const py::object& source, const py::object& target, const std::string& by) {
            CircleMatchingOptions options;
            options.by = Keywords::choice<MatchBy>("by", py::str(by),
                                                   {{"position", MatchBy::position}, {"size", MatchBy::size}});
            const CircleMatching found = match_circle_domains(holes_from(source), holes_from(target), options);
            return py::make_tuple(index_array(found.partner), found.move.rotation, found.move.centre, found.distance);
        },
        py::arg("source"), py::arg("target"), py::arg("by") = "position",
        "A correspondence of the holes of two circle domains, each (loop, centre, radius) or (centre, "
        "radius).\n\nReturns "
        "the partner of every hole, rotation and centre of the Möbius map z ↦ e^{iα}(z − a)/(1 − āz) of the source, "
        "and "
        "the root mean square of hyperbolic distances.\n\nRaises BadBoundary if the numbers differ.");
}

}  // namespace beltrami::python
