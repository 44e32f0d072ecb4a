#include <beltrami/report/record_json.h>
#include <beltrami/teichmuller/extremal_between.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

struct BetweenObject {
    ExtremalPtr plane;
    Places places;
    Positions positions;
    std::vector<int> partner;
    Record record;
};

BetweenObject between(const SurfacePtr& source, const SurfacePtr& target, const py::object& pairs,
                      const py::kwargs& given) {
    const std::vector<std::array<int, 2>> list = whole_pairs(pairs, "pairs");
    Interruption interruption;
    ExtremalOptions options;
    Correspondence wanted;
    Keywords keywords(given);
    take_extremal(keywords, interruption, {source.get(), target.get()}, options);
    take_correspondence(keywords, wanted);
    keywords.finish();
    const double start = seconds();
    return without_lock(interruption, [&] {
        ExtremalMapBetween result = extremal_map_between(source->surface, target->surface, list, wanted, options);
        BetweenObject object;
        const CorrespondenceRecord about = correspondence_record(result, "", list.size());
        object.plane = std::make_shared<ExtremalObject>(source, std::move(result.plane), seconds() - start);
        object.record = object.plane->record();
        object.record.correspondence = about;
        object.places.points = std::move(result.places);
        object.positions = std::move(result.positions);
        object.partner = std::move(result.target.correspondence.partner);
        return object;
    });
}

}  // namespace

void bind_between(py::module_& m) {
    py::class_<BetweenObject>(m, "ExtremalMapBetween", "An extremal map onto a surface whose boundary is prescribed.")
        .def_readonly("plane", &BetweenObject::plane, "The ExtremalMap to the target's circle domain")
        .def_readonly("places", &BetweenObject::places, "#V Places on the target's faces")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const BetweenObject&>().positions, self); },
            "#V×3 (or ×2, as the target has them) their positions")
        .def_readonly("partner", &BetweenObject::partner, "Of every boundary loop of the source, that of the target")
        .def(
            "to_json", [](const BetweenObject& o) { return to_json(o.record); }, "The record as JSON (docs/json.md).")
        .def("__repr__",
             [](const BetweenObject& o) { return "<beltrami map onto a surface: " + o.plane->summary() + ">"; });
    m.def("extremal_map_between", &between, py::arg("source"), py::arg("target"), py::arg("pairs"),
          (std::string(
               "The extremal map of a surface onto another one with prescribed boundary correspondence.\n\n"
               "pairs: n×2 (boundary vertex of the source, of the target), at least one on every loop; arc length "
               "between them. Also outer_loop, turns, waypoints as of Constraints.\n\n") +
           kExtremalOptions)
              .c_str());
}

}  // namespace beltrami::python
