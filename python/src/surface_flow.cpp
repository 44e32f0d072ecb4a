#include <beltrami/flow/ring_module.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/solve/quasiconformal_map.h>

#include "extremal_map.h"
#include "module.h"
#include "space_map.h"
#include "space_targets.h"

namespace beltrami::python {

namespace {

/// A map along a surface in space.
class SurfaceFlowObject final : public SpaceMap {
  public:
    SurfaceFlowObject(const SurfacePtr& source, const char* method, SurfaceFlowMap found, Record record)
        : SpaceMap(source, method, positions_of(found.map.points), found.distortion, std::move(record)),
          found_(std::move(found)) {}
    const SurfaceFlowMap& found() const { return found_; }

  private:
    SurfaceFlowMap found_;
};
using SurfaceFlowPtr = std::shared_ptr<SurfaceFlowObject>;

struct Asked {
    SurfaceFlowOptions options;
    std::function<bool(int, double)> progress;

    Asked(Interruption& interruption, const py::kwargs& given) {
        Keywords keywords(given);
        keywords.take("tolerance", options.tolerance);
        keywords.take("least_decrease", options.least_decrease);
        keywords.take("max_iterations", options.max_iterations);
        keywords.choose<FlowScheme>("scheme", options.scheme,
                                    {{"automatic", FlowScheme::automatic},
                                     {"residual", FlowScheme::residual},
                                     {"perturbation", FlowScheme::perturbation},
                                     {"barrier", FlowScheme::barrier}});
        keywords.progress(interruption, progress);
        keywords.finish();
        if (progress)
            options.progress = [this](int iteration, const SurfaceFlowIteration& now, const TargetMap&) {
                return progress(iteration, now.error.l2);
            };
    }
    Asked(const Asked&) = delete;
};

SurfaceFlowPtr object_of(const SurfacePtr& source, const char* method, SurfaceFlowMap found, SurfaceFlowRecord about,
                         double begun) {
    Record record = space_record(source, "flow", map_record(found.distortion), found.warnings);
    record.solve = solve_record(found, seconds() - begun);
    about.error = found.error;
    about.fits = found.fits;
    about.history = found.history;
    record.surface_flow = std::move(about);
    return std::make_shared<SurfaceFlowObject>(source, method, std::move(found), std::move(record));
}

SurfaceFlowPtr flow(const SurfacePtr& source, const py::object& target, const py::object& mu,
                    const py::object& constraints, const py::object& start, const py::kwargs& given) {
    const TargetPtr to = target_of(target);
    const Eigen::VectorXcd samples = samples_of(*source, mu, "mu");
    const TargetConstraints kept = target_constraints_of(constraints);
    Interruption interruption;
    const Asked asked(interruption, given);
    TargetMap from = start_on(source, *to, kept, start);
    const double begun = seconds();
    return without_lock(interruption, [&] {
        SurfaceFlowRecord about;
        about.coefficient = "";
        about.held = static_cast<int>(kept.fixed.size());
        about.sliding = static_cast<int>(kept.sliding.size());
        return object_of(source, "flow",
                         surface_flow(source->surface, *to, samples, kept, std::move(from), asked.options), about,
                         begun);
    });
}

SurfaceFlowPtr least_lp(const SurfacePtr& source, const py::object& target, double p, const py::object& weights,
                        const py::object& constraints, const py::object& start, const py::kwargs& given) {
    const TargetPtr to = target_of(target);
    LpNorm norm{p, {}};
    if (!weights.is_none()) {
        const Eigen::VectorXd list = real_numbers(weights, "weights");
        norm.weights.assign(list.begin(), list.end());
        if (norm.weights.empty()) throw Error(Cause::bad_option, "weights are empty");
    }
    const TargetConstraints kept = target_constraints_of(constraints);
    Interruption interruption;
    const Asked asked(interruption, given);
    TargetMap from = start_on(source, *to, kept, start);
    const double begun = seconds();
    return without_lock(interruption, [&] {
        SurfaceFlowRecord about;
        about.p = p;
        about.weight = norm.weights.empty() ? "area" : "given";
        about.held = static_cast<int>(kept.fixed.size());
        about.sliding = static_cast<int>(kept.sliding.size());
        return object_of(source, "least lp",
                         least_lp_map(source->surface, *to, norm, kept, std::move(from), asked.options), about, begun);
    });
}

constexpr const char* kAlong =
    "target: a Target, Surface, Mesh or TargetDomain. constraints: TargetConstraints (None: nothing is held). start: a "
    "TargetMap, or #V×3 points near the target (None: the source's own vertices).\n\nOptions: tolerance=1e-8 (of the "
    "image's diameter), least_decrease=1e-4, max_iterations=100, scheme=\"automatic\" | \"residual\" | "
    "\"perturbation\" "
    "| \"barrier\", progress=None: called as progress(iteration, error), False stops (Cancelled).\n\nRaises BadOption, "
    "BadBoundary, NotSolved, Cancelled. Source: Wong & Zhao 2014.";

}  // namespace

void bind_surface_flow(py::module_& m) {
    py::class_<SurfaceFlowObject, SpaceMap, SurfaceFlowPtr>(
        m, "SurfaceFlowMap", "A map along a surface in space, by a flow of the surface's own points.")
        .def_property_readonly(
            "target_map", [](const SurfaceFlowObject& o) { return o.found().map; },
            "The TargetMap: points, normals, places")
        .def_property_readonly(
            "places", [](const SurfaceFlowObject& o) { return Places{places_of(o.found().map.points)}; },
            "Places on the mesh of a MeshTarget; face -1 elsewhere")
        .def_property_readonly(
            "fits", [](const SurfaceFlowObject& o) { return o.found().fits; },
            "Whether the coefficient belongs to a map onto this target, as far as the mesh can tell")
        .def_property_readonly(
            "l2", [](const SurfaceFlowObject& o) { return o.found().error.l2; },
            "Root mean square of |μ_f − μ| over the source's area")
        .def_property_readonly("sup", [](const SurfaceFlowObject& o) { return o.found().error.sup; })
        .def_property_readonly(
            "energies",
            [](const SurfaceFlowObject& o) {
                std::vector<double> energies;
                for (const SurfaceFlowIteration& step : o.found().history) energies.push_back(step.energy);
                return number_array(energies);
            },
            "What every step made small, after it");
    m.def("surface_flow", &flow, py::arg("source"), py::arg("target"), py::arg("mu"),
          py::arg("constraints") = py::none(), py::arg("start") = py::none(),
          (std::string(
               "The map of a surface of any topology along a target that has a given Beltrami coefficient, by the "
               "discrete Beltrami flow.\n\nmu: #S or #F complex in the samples' frames, |μ| < 1. ") +
           kAlong)
              .c_str());
    m.def("least_lp_map", &least_lp, py::arg("source"), py::arg("target"), py::arg("p") = 2.0,
          py::arg("weights") = py::none(), py::arg("constraints") = py::none(), py::arg("start") = py::none(),
          (std::string("The map along a target of least Lᵖ norm of |μ|, without flips.\n\np: at least 2. weights: #S "
                       "(None: areas; flat_areas of a torus make p = 2 the extremal map). ") +
           kAlong)
              .c_str());
    m.def(
        "ring_module",
        [](const SurfacePtr& surface, const py::object& mu, int outer_loop) {
            require_loop(*surface, outer_loop);
            const Eigen::VectorXcd samples = mu.is_none()
                                                 ? Eigen::VectorXcd(Eigen::VectorXcd::Zero(surface->sample_count()))
                                                 : samples_of(*surface, mu, "mu");
            require_coefficient(surface->surface, samples);
            return without_lock([&] { return ring_module(surface->surface, samples, outer_loop); });
        },
        py::arg("surface"), py::arg("mu") = py::none(), py::arg("outer_loop") = 0,
        "The conformal module log(R/r) of a surface with two boundary loops in the structure |dz + μ dz̄|²: its maps "
        "with "
        "this coefficient go onto round rings of this module and onto no others.\n\nmu: #S or #F (None: 0).\n\nRaises "
        "BadMesh unless it is one component of genus 0 with two loops; BadOption naming samples; NotSolved.");
}

}  // namespace beltrami::python
