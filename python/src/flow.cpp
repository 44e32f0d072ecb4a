#include <beltrami/baselines/t_map_scheme.h>
#include <beltrami/flow/beltrami_flow.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A map whose boundary slid onto a domain.
template <class Result>
class SlidObject final : public PlanarMap {
  public:
    SlidObject(const SurfacePtr& surface, std::string method, Result result)
        : PlanarMap(surface, surface), method_(std::move(method)), result_(std::move(result)) {}
    const Eigen::VectorXcd& map() const override { return result_.map; }
    const Distortion& distortion() const override { return result_.distortion; }
    const Warnings& warnings() const override { return result_.warnings; }
    std::string method() const override { return method_; }
    Record record() const override {
        Record record = record_of(*this, "flow");
        record.solve.emplace();
        record.solve->iterations = result_.iterations;
        record.solve->factorizations = result_.factorizations;
        record.solve->termination = to_string(result_.termination);
        if constexpr (std::is_same_v<Result, FlowMap>)
            record.flow = FlowRecord{"", std::string(), result_.error, result_.fits, result_.loops};
        return record;
    }
    const Result& result() const { return result_; }

  private:
    std::string method_;
    Result result_;
};
using FlowObject = SlidObject<FlowMap>;
using SchemeObject = SlidObject<TMapSchemeResult>;

SlidingStart start_of(const SurfacePtr& surface, const TargetDomain& target,
                      const std::optional<Eigen::VectorXcd>& start, const Correspondence& wanted,
                      double target_edge_length) {
    if (start) return flow_start(surface->surface, target, *start);
    FlowStartOptions options;
    options.target_edge_length = target_edge_length;
    options.shapes = {&surface->shape};
    return flow_start(surface->surface, target, wanted, options);
}

struct Wishes {
    Correspondence wanted;
    std::optional<Eigen::VectorXcd> start;
    double target_edge_length = 0;

    void take(Keywords& keywords, const SurfaceObject& surface) {
        take_correspondence(keywords, wanted);
        keywords.take("target_edge_length", target_edge_length);
        if (const py::object given = keywords.taken("start"); given && !given.is_none())
            start = map_of(surface, given, "start");
    }
};

std::shared_ptr<FlowObject> flow(const SurfacePtr& surface, const TargetDomain& target, const py::object& mu,
                                 const py::kwargs& given) {
    const Eigen::VectorXcd samples = samples_of(*surface, mu, "mu");
    Interruption interruption;
    FlowOptions options;
    Wishes wishes;
    Keywords keywords(given);
    wishes.take(keywords, *surface);
    keywords.take("tolerance", options.tolerance);
    keywords.take("max_iterations", options.max_iterations);
    keywords.take("step", options.step);
    std::function<bool(int, double)> progress;
    keywords.progress(interruption, progress);
    keywords.finish();
    if (progress)
        options.progress = [&](int iteration, const FlowIteration& state, const Eigen::VectorXcd&) {
            return progress(iteration, state.error.l2);
        };
    return without_lock(interruption, [&] {
        const SlidingStart start = start_of(surface, target, wishes.start, wishes.wanted, wishes.target_edge_length);
        return std::make_shared<FlowObject>(surface, "flow", beltrami_flow(surface->surface, samples, start, options));
    });
}

std::shared_ptr<SchemeObject> scheme(const SurfacePtr& surface, const TargetDomain& target, const py::kwargs& given) {
    Interruption interruption;
    TMapSchemeOptions options;
    Wishes wishes;
    Keywords keywords(given);
    wishes.take(keywords, *surface);
    using Projection = TMapSchemeOptions::Projection;
    keywords.choose<Projection>(
        "projection", options.projection,
        {{"fixed_boundary", Projection::fixed_boundary}, {"sliding_boundary", Projection::sliding_boundary}});
    keywords.take("damping", options.damping);
    keywords.take("projection_steps", options.projection_steps);
    keywords.take("smoothing", options.smoothing);
    keywords.take("smoothing_passes", options.smoothing_passes);
    keywords.take("initial_steps", options.initial_steps);
    keywords.take("tolerance", options.tolerance);
    keywords.take("max_solves", options.max_solves);
    std::function<bool(int, double)> progress;
    keywords.progress(interruption, progress);
    keywords.finish();
    if (progress) options.progress = [&](int solve, const TMapSolve& state) { return progress(solve, state.mean); };
    return without_lock(interruption, [&] {
        const SlidingStart start = start_of(surface, target, wishes.start, wishes.wanted, wishes.target_edge_length);
        return std::make_shared<SchemeObject>(surface, "t-map", t_map_scheme(surface->surface, start, options));
    });
}

}  // namespace

void bind_flow(py::module_& m) {
    py::class_<FlowObject, PlanarMap, std::shared_ptr<FlowObject>>(m, "FlowMap",
                                                                   "A map with a prescribed coefficient onto a domain.")
        .def_property_readonly(
            "fits", [](const FlowObject& o) { return o.result().fits; },
            "Whether the coefficient belongs to a map onto this target, as far as the mesh can tell")
        .def_property_readonly(
            "l2", [](const FlowObject& o) { return o.result().error.l2; },
            "Root mean square of |μ_f − μ| over the source's area")
        .def_property_readonly("sup", [](const FlowObject& o) { return o.result().error.sup; })
        .def_property_readonly("iterations", [](const FlowObject& o) { return o.result().iterations; });
    py::class_<SchemeObject, PlanarMap, std::shared_ptr<SchemeObject>>(
        m, "TMapSchemeResult", "What the scheme of Ng, Gu & Lui 2014 ends with.")
        .def_property_readonly("solves", [](const SchemeObject& o) { return o.result().solves; });
    m.def("beltrami_flow", &flow, py::arg("surface"), py::arg("target"), py::arg("mu"),
          "From a start to the map with a given coefficient, its boundary sliding along the curves of a TargetDomain "
          "(Ng, Gu "
          "& Lui 2014, sections 5.1 and 6.1).\n\nmu: #S or #F complex in the samples' frames, |μ| < 1.\n\nOptions: "
          "tolerance=1e-10, max_iterations=60, step=1, start=None (#V map), target_edge_length=0, progress=None "
          "(iteration, "
          "error), and those of Constraints for the correspondence.\n\nRaises BadMesh, BadOption, BadBoundary, "
          "NotSolved, "
          "Cancelled.");
    m.def("t_map_scheme", &scheme, py::arg("surface"), py::arg("target"),
          "The scheme of Ng, Gu & Lui 2014 (Algorithm 3), to compare with extremal_map.\n\nOptions: "
          "projection=\"fixed_boundary\" | \"sliding_boundary\", damping=0.1, projection_steps=5, smoothing=0.75, "
          "smoothing_passes=1, initial_steps=1, tolerance=1e-3, max_solves=200, start=None, target_edge_length=0, "
          "progress=None.\n\nRaises BadMesh, BadOption, BadBoundary, NotSolved, Cancelled.");
    m.def(
        "coefficient_error",
        [](const SurfacePtr& surface, const py::object& map, const py::object& mu) {
            const CoefficientError error =
                coefficient_error(surface->surface, map_of(*surface, map), samples_of(*surface, mu, "mu"));
            py::dict result;
            result["l2"] = error.l2;
            result["sup"] = error.sup;
            result["residual"] = error.residual;
            result["misfit"] = error.misfit;
            result["fits"] = coefficient_fits(error);
            return result;
        },
        py::arg("surface"), py::arg("map"), py::arg("mu"),
        "How far a map is from having a coefficient: l2, sup, residual, misfit, and whether it fits.");
}

}  // namespace beltrami::python
