#include <beltrami/applications/deform.h>

#include "extremal_map.h"
#include "module.h"
#include "space_map.h"
#include "space_targets.h"

namespace beltrami::python {

namespace {

/// A surface deformed by handles.
class DeformationObject final : public SpaceMap {
  public:
    DeformationObject(const SurfacePtr& source, Deformation found, Record record)
        : SpaceMap(source, "deformed", found.positions, found.distortion, std::move(record)),
          found_(std::move(found)) {}
    const Deformation& found() const { return found_; }

  private:
    Deformation found_;
};
using DeformationPtr = std::shared_ptr<DeformationObject>;

/// A solver that owns what it refers to.
class DeformObject {
  public:
    DeformObject(const SurfacePtr& surface, const py::object& handles, const py::kwargs& given)
        : surface_(in_space(surface)), handles_(vertex_list(handles, "handles", surface->vertex_count())) {
        DeformOptions options;
        Keywords keywords(given);
        using Kind = DeformedSurface;
        keywords.choose<Kind>("surface", options.surface,
                              {{"automatic", Kind::automatic},
                               {"thin_plate", Kind::thin_plate},
                               {"rigid", Kind::rigid},
                               {"uniform", Kind::uniform}});
        using Goal = DeformGoal;
        keywords.choose<Goal>("minimize", options.goal,
                              {{"dilatation", Goal::dilatation}, {"maximum", Goal::largest}, {"spread", Goal::spread}});
        keywords.take("last_power", options.last_power);
        keywords.take("steps_of_power", options.steps_of_power);
        keywords.take("tolerance", options.tolerance);
        keywords.progress(interruption_, options.progress);
        keywords.finish();
        solver_ = without_lock(interruption_,
                               [&] { return std::make_unique<DeformSolver>(surface_->surface, handles_, options); });
    }

    DeformationPtr solve(const py::object& places, const py::object& onto) {
        const Positions at = points_of(places, "places", static_cast<int>(handles_.size()), 3);
        const std::shared_ptr<MeshTarget> target = onto.is_none() ? nullptr : mesh_target_of(onto);
        const double begun = seconds();
        return without_lock(interruption_, [&] {
            const std::lock_guard lock(mutex_);
            Deformation found = target ? solver_->solve_onto(*target, at) : solver_->solve(at);
            Record record = space_record(surface_, "deform", map_record(found.distortion), found.warnings);
            record.solve =
                solve_of(found.steps, found.factorizations,
                         found.settled ? Termination::converged : Termination::iteration_limit, seconds() - begun);
            record.deform = {to_string(found.kind),
                             to_string(found.goal),
                             static_cast<int>(handles_.size()),
                             found.of_surface.mean,
                             found.of_surface.max,
                             found.area_ratio,
                             found.folds};
            return std::make_shared<DeformationObject>(surface_, std::move(found), std::move(record));
        });
    }

    const std::vector<int>& handles() const { return handles_; }

  private:
    SurfacePtr surface_;
    std::vector<int> handles_;
    Interruption interruption_;
    std::mutex mutex_;
    std::unique_ptr<DeformSolver> solver_;
};

}  // namespace

void bind_deform(py::module_& m) {
    py::class_<DeformationObject, SpaceMap, DeformationPtr>(m, "Deformation", "A surface deformed by handles.")
        .def_property_readonly(
            "surface", [](const DeformationObject& o) { return o.found().surface; },
            "The Mesh on which the positions are")
        .def_property_readonly(
            "places", [](const DeformationObject& o) { return Places{o.found().places}; }, "#V Places on that mesh")
        .def_property_readonly(
            "kind", [](const DeformationObject& o) { return std::string(to_string(o.found().kind)); },
            "How that surface was found")
        .def_property_readonly(
            "minimized", [](const DeformationObject& o) { return std::string(to_string(o.found().goal)); },
            "What was made small of the map onto it: \"K\", \"max\" or \"spread\"; another one than wished for where "
            "warnings say so")
        .def_property_readonly(
            "K_lower",
            [](const DeformationObject& o) {
                return o.found().extremal ? std::optional(o.found().extremal->K_lower) : std::nullopt;
            },
            "Where K was made small: an estimate of a lower bound, of the map in the plane by way of which it was "
            "found")
        .def_property_readonly(
            "settled", [](const DeformationObject& o) { return o.found().settled; },
            "What is made small hardly changed in the end")
        .def_property_readonly(
            "of_surface", [](const DeformationObject& o) { return o.found().of_surface; },
            "Distortion of that surface's own vertices, with which it began")
        .def_property_readonly(
            "area_ratio", [](const DeformationObject& o) { return o.found().area_ratio; },
            "Of that surface to the source")
        .def_property_readonly(
            "folds", [](const DeformationObject& o) { return pairs_array(o.found().folds); },
            "n×2 edges at which the result folds and the source does not");
    py::class_<DeformObject>(
        m, "DeformSolver",
        "Deforms a surface in space by handles, vertices with prescribed places, with small dilatation and without "
        "folds; a solve goes on from the last one.")
        .def(py::init([](const SurfacePtr& surface, const py::object& handles, const py::kwargs& given) {
                 return std::make_unique<DeformObject>(surface, handles, given);
             }),
             py::arg("source"), py::arg("handles"),
             "handles: n different vertices, at least one on every component.\n\nOptions: surface=\"automatic\" | "
             "\"thin_plate\" | \"rigid\" | \"uniform\" (the surface on which the result lies), minimize=\"maximum\" | "
             "\"dilatation\" (where the whole boundary of a source of genus 0 is held) | \"spread\", last_power=32 (2: "
             "the "
             "mean, 32: the largest |μ|), steps_of_power=12, tolerance=3e-3, progress=None.\n\nRaises BadBoundary, "
             "BadOption.")
        .def_property_readonly("handles", [](const DeformObject& o) { return index_array(o.handles()); })
        .def(
            "solve", [](DeformObject& o, const py::object& places) { return o.solve(places, py::none()); },
            py::arg("places"),
            "places: n×3 of the handles. Returns a Deformation, extremal for its surface only.\n\nRaises BadBoundary "
            "if "
            "every surface has folds, naming edges; BadOption, NotSolved, Cancelled.")
        .def(
            "solve_onto",
            [](DeformObject& o, const py::object& target, const py::object& places) {
                if (target.is_none()) throw py::type_error("target is a MeshTarget, a Mesh or a Surface");
                return o.solve(places, target);
            },
            py::arg("target"), py::arg("places"),
            "Onto a given surface (MeshTarget, Mesh or Surface); handles go to its nearest points.\n\nRaises NotSolved "
            "naming faces where the start folds; BadOption, Cancelled.")
        .def("__repr__", [](const DeformObject& o) {
            return "<beltrami.DeformSolver: " + std::to_string(o.handles().size()) + " handles>";
        });
}

}  // namespace beltrami::python
