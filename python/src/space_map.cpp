#include "space_map.h"

#include <cstdio>

#include <beltrami/report/record_json.h>
#include <beltrami/report/record_text.h>

#include "module.h"

namespace beltrami::python {

std::string SpaceMap::summary() const {
    char text[200] = "";
    if (record_.map && record_.map->K)
        std::snprintf(text, sizeof text, "%s, K %.5f, mean |mu| %.4f, %zu flipped", method_.c_str(), *record_.map->K,
                      distortion_.mean, distortion_.flipped.size());
    else
        std::snprintf(text, sizeof text, "%s, K_max %.4f, mean |mu| %.4f, %zu flipped", method_.c_str(),
                      distortion_.K_max(), distortion_.mean, distortion_.flipped.size());
    return text + (record_.solve ? ", " + record_.solve->termination : std::string());
}

std::string SpaceMap::page(const std::string& title) const {
    PageContent content{source_->surface.mesh, {}, {}, {}, {}, to_json(record_), title};
    content.maps.push_back({method_, positions_, distortion_.face_abs_mu});
    if (record_.solve)
        for (const Iteration& iteration : record_.solve->history) {
            content.history_k.push_back(iteration.k);
            content.history_change.push_back(iteration.change);
            content.history_largest.push_back(iteration.largest);
        }
    return render_page(content);
}

Record space_record(const SurfacePtr& source, const std::string& command, MapRecord map, Warnings warnings) {
    Record record;
    record.command = command;
    record.source = source_record(source->surface);
    record.map = std::move(map);
    record.warnings = std::move(warnings);
    return record;
}

SolveRecord solve_of(int iterations, int factorizations, Termination termination, double seconds) {
    SolveRecord solve;
    solve.iterations = iterations;
    solve.factorizations = factorizations;
    solve.termination = to_string(termination);
    solve.seconds_total = seconds;
    return solve;
}

void bind_space_maps(py::module_& m) {
    py::class_<SpaceMap, std::shared_ptr<SpaceMap>>(
        m, "SpaceMap",
        "A map of a surface into space, along a target, or onto another surface: what such results share.")
        .def_property_readonly("source", &SpaceMap::source, "The surface that was given.")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const SpaceMap&>().positions(), self); },
            "#V×3 (onto a surface of the plane #V×2) images of the vertices, in the units of the target")
        .def_property_readonly(
            "distortion", [](const SpaceMap& map) -> const Distortion& { return map.distortion(); },
            "Distortion of the faces")
        .def_property_readonly(
            "mu", [](const py::object& self) { return view(self.cast<const SpaceMap&>().distortion().mu, self); },
            "#S Beltrami coefficient at the samples, in their frames")
        .def_property_readonly(
            "K_max", [](const SpaceMap& map) { return map.distortion().K_max(); },
            "Largest dilatation of a face, infinite where one is flipped")
        .def_property_readonly(
            "no_flips",
            [](const SpaceMap& map) { return map.distortion().flipped.empty() && map.distortion().degenerate.empty(); },
            "Whether no face is flipped or collapsed")
        .def_property_readonly("warnings", [](const SpaceMap& map) { return map.record().warnings; })
        .def_property_readonly("method", &SpaceMap::method)
        .def_property_readonly(
            "termination",
            [](const SpaceMap& map) { return map.record().solve ? map.record().solve->termination : std::string(); },
            "\"converged\", \"iteration_limit\", \"unconfirmed\" …")
        .def_property_readonly(
            "iterations", [](const SpaceMap& map) { return map.record().solve ? map.record().solve->iterations : 0; },
            "Linear solves")
        .def_property_readonly(
            "seconds", [](const SpaceMap& map) { return map.record().solve ? map.record().solve->seconds_total : 0.0; },
            "That it took")
        .def(
            "to_json", [](const SpaceMap& map) { return to_json(map.record()); }, "The record as JSON (docs/json.md).")
        .def(
            "_page",
            [](const SpaceMap& map, const std::string& title) { return without_lock([&] { return map.page(title); }); },
            py::arg("title"))
        .def("__str__",
             [](const SpaceMap& map) {
                 return to_table(map.record(), map.method()) + to_remarks(map.record()) + to_sentence(map.record());
             })
        .def("__repr__", [](const SpaceMap& map) { return "<beltrami map in space: " + map.summary() + ">"; });

    py::class_<CarriedObject, SpaceMap, std::shared_ptr<CarriedObject>>(m, "CarriedSurface",
                                                                        "A surface on the faces of another one.")
        .def_property_readonly("places", &CarriedObject::places, "#V Places of the source's vertices on the target")
        .def_property_readonly("in_space", &CarriedObject::in_space,
                               "Distortion of the straight faces between these, which may be flipped though the map is "
                               "not")
        .def_property_readonly(
            "unresolved", [](const CarriedObject& o) { return index_array(o.unresolved()); },
            "Faces on which the mesh does not resolve the map")
        .def_property_readonly("largest_distance", &CarriedObject::largest_distance,
                               "Of soft landmarks from their places; None without any");
}

}  // namespace beltrami::python
