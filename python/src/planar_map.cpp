#include "planar_map.h"

#include <cmath>
#include <cstdio>

#include <beltrami/report/record_json.h>
#include <beltrami/report/record_text.h>
#include <beltrami/solve/composition.h>

#include "module.h"

namespace beltrami::python {

std::string PlanarMap::summary() const {
    const Distortion& measured = distortion();
    char text[160];
    std::snprintf(text, sizeof text, "%s, K_max %.4f, mean |mu| %.4f, %zu flipped", method().c_str(), measured.K_max(),
                  measured.mean, measured.flipped.size());
    return text;
}

std::string PlanarMap::page(const std::string& title) const {
    PageContent content{surface_->surface.mesh, {}, {}, {}, {}, to_json(record()), title};
    content.maps.push_back({method(), plane_positions(map()), distortion().face_abs_mu, differential()});
    for (PageMap& other : other_pages()) content.maps.push_back(std::move(other));
    for (const Iteration& iteration : history()) {
        content.history_k.push_back(iteration.k);
        content.history_change.push_back(iteration.change);
        content.history_largest.push_back(iteration.largest);
    }
    return render_page(content);
}

const MapEvaluation& PlanarMap::evaluation() const {
    std::call_once(evaluated_, [&] { evaluation_.emplace(surface_->surface.mesh, map()); });
    return *evaluation_;
}

Positions plane_positions(const Eigen::VectorXcd& map) {
    Positions positions(map.size(), 2);
    positions.col(0) = map.real();
    positions.col(1) = map.imag();
    return positions;
}

Record record_of(const PlanarMap& map, const std::string& command) {
    Record record;
    record.command = command;
    record.source = source_record(map.source()->surface);
    record.map = map_record(map.distortion());
    record.warnings = map.warnings();
    return record;
}

namespace {

/// A map of one's own, measured.
class GivenMap final : public PlanarMap {
  public:
    GivenMap(SurfacePtr surface, Eigen::VectorXcd map)
        : PlanarMap(surface, surface),
          map_(std::move(map)),
          distortion_(beltrami::distortion(surface->surface.operators, map_)) {}
    const Eigen::VectorXcd& map() const override { return map_; }
    const Distortion& distortion() const override { return distortion_; }
    const Warnings& warnings() const override { return warnings_; }
    std::string method() const override { return "given"; }
    Record record() const override { return record_of(*this, "measure"); }

  private:
    Eigen::VectorXcd map_;
    Distortion distortion_;
    Warnings warnings_;
};

Eigen::VectorXcd images(const PlanarMap& map, const py::object& points) {
    if (py::isinstance<Places>(points)) {
        const auto& places = points.cast<const Places&>();
        require_on(map.surface()->surface.mesh, places);
        Eigen::VectorXcd result(places.points.size());
        for (std::size_t i = 0; i < places.points.size(); ++i)
            result[static_cast<Eigen::Index>(i)] = map.evaluation().image(places.points[i]);
        return result;
    }
    const Positions at = python::points(points, "points");
    return without_lock([&] {
        const MapEvaluation& evaluation = map.evaluation();
        Eigen::VectorXcd result(at.rows());
        for (Eigen::Index i = 0; i < at.rows(); ++i)
            result[i] =
                evaluation.image(evaluation.nearest({at(i, 0), at(i, 1), at.cols() > 2 ? at(i, 2) : 0.0}).place);
        return result;
    });
}

Places preimages(const PlanarMap& map, const py::object& points, double tolerance) {
    const std::vector<Complex> at = complex_list(points, "points");
    for (std::size_t i = 0; i < at.size(); ++i)
        if (!std::isfinite(at[i].real()) || !std::isfinite(at[i].imag()))
            throw Error(Cause::bad_option, "points are not finite, the first is point " + std::to_string(i), {},
                        {Things::points, {static_cast<int>(i)}});
    return without_lock([&] { return Places{map.evaluation().preimages(at, tolerance)}; });
}

Positions inverse(const PlanarMap& map, const py::object& points, double tolerance) {
    const Places places = preimages(map, points, tolerance);
    const Positions& positions = map.surface()->surface.mesh.positions;
    Positions result = Positions::Zero(places.points.size(), positions.cols());
    for (std::size_t i = 0; i < places.points.size(); ++i)
        for (int j = 0; j < 3; ++j)
            result.row(static_cast<Eigen::Index>(i)) +=
                places.points[i].barycentric[j] * positions.row(places.points[i].vertices[j]);
    return result;
}

}  // namespace

void bind_maps(py::module_& m) {
    py::class_<PlanarMap, std::shared_ptr<PlanarMap>>(
        m, "PlanarMap", "A map of a surface to the plane. Called with points it gives their images.")
        .def(py::init([](const SurfacePtr& surface, const py::object& map) {
                 return std::shared_ptr<PlanarMap>(std::make_shared<GivenMap>(surface, map_of(*surface, map)));
             }),
             py::arg("surface"), py::arg("map"), "A map of one's own, measured: #V complex or #V×2 images.")
        .def_property_readonly("source", &PlanarMap::source, "The surface that was given.")
        .def_property_readonly(
            "surface", &PlanarMap::surface,
            "Whose vertices the map has: the source, or, where edges had to be split, what it became: "
            "its own vertices come first.")
        .def_property_readonly(
            "map", [](const py::object& self) { return view(self.cast<const PlanarMap&>().map(), self); },
            "#V complex images, in the units of what was prescribed")
        .def_property_readonly(
            "uv",
            [](const py::object& self) {
                const Eigen::VectorXcd& map = self.cast<const PlanarMap&>().map();
                py::array_t<double> result({static_cast<py::ssize_t>(map.size()), py::ssize_t{2}},
                                           reinterpret_cast<const double*>(map.data()), self);
                result.attr("setflags")(py::arg("write") = false);
                return result;
            },
            "#V×2, the same numbers as map")
        .def_property_readonly(
            "distortion", [](const PlanarMap& map) -> const Distortion& { return map.distortion(); },
            "Distortion of the faces")
        .def_property_readonly(
            "mu", [](const py::object& self) { return view(self.cast<const PlanarMap&>().distortion().mu, self); },
            "#S Beltrami coefficient at the samples, in their frames")
        .def_property_readonly(
            "K_max", [](const PlanarMap& map) { return map.distortion().K_max(); },
            "Largest dilatation of a face, infinite where one is flipped")
        .def_property_readonly(
            "one_to_one",
            [](const PlanarMap& map) {
                return map.distortion().flipped.empty() && map.distortion().degenerate.empty();
            },
            "Whether no face is flipped or collapsed: with a simple boundary polygon the map is then one-to-one")
        .def_property_readonly("warnings", [](const PlanarMap& map) { return map.warnings(); })
        .def_property_readonly("method", &PlanarMap::method)
        .def("__call__", &images, py::arg("points"),
             "Images of points: n×3 or n×2, or Places; a point that is not on the surface stands for the nearest that "
             "is. "
             "Returns n complex numbers.")
        .def("inverse", &inverse, py::arg("points"), py::arg("tolerance") = MapEvaluation::kTolerance,
             "Points of the surface (n×3, or n×2 in the plane) that go to n complex or n×2 points.\n\ntolerance: how "
             "far "
             "outside the image a point may lie, as part of its diameter.\n\nRaises BadBoundary naming points that lie "
             "farther outside.")
        .def("preimages", &preimages, py::arg("points"), py::arg("tolerance") = MapEvaluation::kTolerance,
             "The same as Places: faces and barycentric coordinates.")
        .def(
            "to_json", [](const PlanarMap& map) { return to_json(map.record()); }, "The record as JSON (docs/json.md).")
        .def(
            "_page",
            [](const PlanarMap& map, const std::string& title) {
                return without_lock([&] { return map.page(title); });
            },
            py::arg("title"))
        .def("__str__",
             [](const PlanarMap& map) {
                 const Record record = map.record();
                 return to_table(record, map.method()) + to_remarks(record) + to_sentence(record);
             })
        .def("__repr__", [](const PlanarMap& map) { return "<beltrami map: " + map.summary() + ">"; });

    m.def(
        "compose_maps",
        [](const py::object& f, const Mesh& middle, const py::object& g, double tolerance) {
            const Eigen::VectorXcd first = complex_numbers(f, "f");
            const Eigen::VectorXcd second = complex_numbers(g, "g", middle.vertex_count(), "vertices");
            return without_lock([&] { return compose_maps(first, middle, second, tolerance); });
        },
        py::arg("f"), py::arg("middle"), py::arg("g"), py::arg("tolerance") = 1e-3,
        "g∘f: f has n images in the planar mesh, g a value at each of its vertices.\n\ntolerance: how far outside a "
        "point may lie, as part of the mesh's diameter.\n\nRaises BadMesh, BadBoundary naming points too far outside.");
}

}  // namespace beltrami::python
