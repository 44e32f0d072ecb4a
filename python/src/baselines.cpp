#include <beltrami/baselines/baseline.h>
#include <beltrami/baselines/t_map_scheme.h>
#include <beltrami/solve/quasiconformal_map.h>
#include <beltrami/unfold/fold_free.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A map by a method of others, or by one linear solve.
class BaselineObject final : public PlanarMap {
  public:
    BaselineObject(const SurfacePtr& surface, std::string method, BaselineMap result, double seconds)
        : PlanarMap(surface, surface),
          method_(std::move(method)),
          result_(std::move(result)),
          distortion_(beltrami::distortion(surface->surface.operators, result_.map)),
          seconds_(seconds) {}
    const Eigen::VectorXcd& map() const override { return result_.map; }
    const Distortion& distortion() const override { return distortion_; }
    const Warnings& warnings() const override { return result_.warnings; }
    std::string method() const override { return method_; }
    Record record() const override {
        Record record = record_of(*this, "map");
        record.solve.emplace();
        record.solve->iterations = result_.iterations;
        record.solve->factorizations = result_.factorizations;
        record.solve->seconds_total = seconds_;
        record.solve->termination =
            to_string(result_.converged ? Termination::converged : Termination::iteration_limit);
        return record;
    }
    const BaselineMap& result() const { return result_; }
    double seconds() const { return seconds_; }

  private:
    std::string method_;
    BaselineMap result_;
    Distortion distortion_;
    double seconds_;
};

using Baseline = BaselineMap (*)(const Surface&, const BoundaryCondition&, const BaselineOptions&);

void bind_baseline(py::module_& m, const std::string& name, Baseline method, const std::string& about) {
    m.def((name + "_baseline").c_str(),
          [name, method](const SurfacePtr& surface, const std::optional<BoundaryCondition>& boundary,
                         const py::kwargs& given) {
              Interruption interruption;
              BaselineOptions options;
              Keywords keywords(given);
              keywords.take("max_iterations", options.max_iterations);
              keywords.take("tolerance", options.tolerance);
              keywords.take("smoothing", options.smoothing);
              keywords.take("smoothing_passes", options.smoothing_passes);
              keywords.progress(interruption, options.progress);
              keywords.finish();
              const double start = seconds();
              return without_lock(interruption, [&] {
                  BaselineMap result = method(surface->surface, boundary.value_or(BoundaryCondition()), options);
                  return std::make_shared<BaselineObject>(surface, name, std::move(result), seconds() - start);
              });
          },
          py::arg("surface"), py::arg("boundary") = py::none(),
          (about +
           "\n\nOptions: max_iterations=1000, tolerance=1e-5, smoothing=0.5, smoothing_passes=1, progress=None.\n\n"
           "Raises BadMesh, BadBoundary, BadOption, NotSolved, Cancelled.")
              .c_str());
}

Eigen::VectorXcd quasiconformal(const SurfacePtr& surface, const py::object& mu, const BoundaryCondition& boundary) {
    const Eigen::VectorXcd samples = samples_of(*surface, mu, "mu");
    return without_lock([&] { return quasiconformal_map(surface->surface, samples, boundary); });
}

py::tuple unfolded(const SurfacePtr& surface, const py::object& start, const py::object& fixed, const py::object& nu,
                   const py::kwargs& given) {
    const Eigen::VectorXcd from = map_of(*surface, start, "start");
    std::vector<Freedom> freedoms(static_cast<std::size_t>(surface->vertex_count()), Freedom::free);
    for (const int v : whole_numbers(fixed, "fixed")) {
        if (v < 0 || v >= surface->vertex_count())
            throw Error(Cause::bad_option, "there is no vertex " + std::to_string(v), {}, {Things::vertices, {v}});
        freedoms[static_cast<std::size_t>(v)] = Freedom::fixed;
    }
    const Eigen::VectorXcd coefficient = nu.is_none()
                                             ? Eigen::VectorXcd(Eigen::VectorXcd::Zero(surface->sample_count()))
                                             : samples_of(*surface, nu, "nu");
    require_coefficient(surface->surface, coefficient);
    Interruption interruption;
    FoldFreeOptions options;
    Keywords keywords(given);
    keywords.take("power", options.power);
    keywords.take("max_iterations", options.max_iterations);
    keywords.take("tolerance", options.tolerance);
    keywords.progress(interruption, options.progress);
    keywords.finish();
    FoldFreeMap result = without_lock(
        interruption, [&] { return fold_free_map(surface->surface, freedoms, coefficient, from, options); });
    return py::make_tuple(std::move(result.map), result.fold_free);
}

}  // namespace

void bind_baselines(py::module_& m) {
    py::class_<BaselineObject, PlanarMap, std::shared_ptr<BaselineObject>>(
        m, "BaselineMap", "A map by a method that others use, to compare extremal maps with.")
        .def_property_readonly("iterations", [](const BaselineObject& o) { return o.result().iterations; })
        .def_property_readonly("converged", [](const BaselineObject& o) { return o.result().converged; })
        .def_property_readonly("seconds", &BaselineObject::seconds);
    bind_baseline(m, "harmonic", harmonic_baseline,
                  "The harmonic map (Pinkall & Polthier 1993); the whole boundary is prescribed.");
    bind_baseline(m, "lscm", lscm_baseline,
                  "The least-squares conformal map (Lévy et al. 2002): two or more pins, or none; the rest is free.");
    bind_baseline(m, "tutte", tutte_baseline, "Tutte's map (1963); the whole boundary is prescribed.");
    bind_baseline(m, "mean_value", mean_value_baseline,
                  "The same with Floater's mean value weights (2003), which see the shapes.");
    bind_baseline(m, "arap", arap_baseline,
                  "As rigid as possible (Liu, Zhang, Xu, Gotsman, Gortler 2008); any number of pins.");
    bind_baseline(m, "mips", mips_baseline,
                  "MIPS, the most isometric parametrization (Hormann & Greiner 1999), without folds.");
    bind_baseline(m, "alternation", alternation_baseline,
                  "The alternation of Weber, Myles & Zorin 2012 for the Teichmüller map, as the paper has it.");
    bind_baseline(m, "qc_iteration", qc_iteration_baseline, "The QC iteration of Lui, Gu & Yau 2014.");
    m.def(
        "quasiconformal_map", &quasiconformal, py::arg("surface"), py::arg("mu"), py::arg("boundary"),
        "The map with a given Beltrami coefficient, ∂̄f = μ∂f, and given boundary values, by one linear solve (Ng, Gu & "
        "Lui 2014, eq. (30), the boundary held). Boundary vertices that are not prescribed are free.\n\nmu: #S or #F "
        "complex in the samples' frames, |μ| < 1. Returns #V complex images.\n\nRaises BadOption naming samples, "
        "BadBoundary, NotSolved naming vertices that are not determined.");
    m.def(
        "fold_free_map", &unfolded, py::arg("surface"), py::arg("start"), py::arg("fixed") = py::list(),
        py::arg("nu") = py::none(),
        "The map without folds that is nearest to having a given coefficient nu (#S or #F; None: 0), from a start (#V) "
        "whose vertices fixed (indices) stay.\n\nOptions: power=1, max_iterations=1000, tolerance=1e-6, "
        "progress=None.\n\nReturns the map (#V complex) and whether it is free of folds. Source: Garanzha et al. "
        "2021.");
}

}  // namespace beltrami::python
