#include <beltrami/teichmuller/least_dilatation.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A map whose largest |μ| is least.
class LeastMaximumObject final : public PlanarMap {
  public:
    LeastMaximumObject(const SurfacePtr& source, LeastMaximumMap result, double power, double seconds)
        : PlanarMap(source, result.split ? make_surface(result.split->mesh, result.split->metric) : source),
          result_(std::move(result)),
          power_(power),
          seconds_(seconds) {}
    const Eigen::VectorXcd& map() const override { return result_.map; }
    const Distortion& distortion() const override { return result_.distortion; }
    const Warnings& warnings() const override { return result_.warnings; }
    std::string method() const override { return "least maximum"; }
    Record record() const override {
        Record record = record_of(*this, "map");
        record.map = map_record(result_);
        record.solve = solve_record(result_, seconds_);
        record.least_maximum = {power_, result_.start_max, result_.distortion.max};
        return record;
    }
    const LeastMaximumMap& result() const { return result_; }

  private:
    LeastMaximumMap result_;
    double power_, seconds_;
};

std::shared_ptr<PlanarMap> least_dilatation(const SurfacePtr& surface, const py::object& what,
                                            const std::string& minimize, double power, const py::kwargs& given) {
    const ConstraintsObject object = constraints_of(what);
    Interruption interruption;
    LeastDilatationOptions options;
    options.what = Keywords::choice<Least>("minimize", py::str(minimize),
                                           {{"dilatation", Least::dilatation}, {"maximum", Least::maximum}});
    Keywords keywords(given);
    take_extremal(keywords, interruption, {surface.get(), object.target.get()}, options.extremal);
    keywords.finish();
    options.maximum.extremal = options.extremal;
    options.maximum.progress = options.extremal.progress;
    options.maximum.power = power;
    const double start = seconds();
    return without_lock(interruption, [&]() -> std::shared_ptr<PlanarMap> {
        LeastDilatationMap found = least_dilatation_map(surface->surface, object.constraints, options);
        if (found.extremal)
            return std::make_shared<ExtremalObject>(surface, std::move(*found.extremal), seconds() - start);
        return std::make_shared<LeastMaximumObject>(surface, std::move(*found.maximum), power, seconds() - start);
    });
}

std::shared_ptr<LeastMaximumObject> least_maximum(const SurfacePtr& surface, const py::object& what,
                                                  const py::kwargs& given) {
    const ConstraintsObject object = constraints_of(what);
    Interruption interruption;
    LeastMaximumOptions options;
    Keywords keywords(given);
    keywords.take("power", options.power);
    keywords.take("newton_iterations", options.max_iterations);
    keywords.take("newton_tolerance", options.tolerance);
    take_extremal(keywords, interruption, {surface.get(), object.target.get()}, options.extremal);
    keywords.finish();
    options.progress = options.extremal.progress;
    const double start = seconds();
    return without_lock(interruption, [&] {
        LeastMaximumMap found = least_maximum_map(surface->surface, object.constraints, options);
        return std::make_shared<LeastMaximumObject>(surface, std::move(found), options.power, seconds() - start);
    });
}

}  // namespace

void bind_least_maximum(py::module_& m) {
    py::class_<LeastMaximumObject, PlanarMap, std::shared_ptr<LeastMaximumObject>>(
        m, "LeastMaximumMap", "The map of this mesh whose largest |μ| is least.")
        .def_property_readonly("start_max", [](const LeastMaximumObject& o) { return o.result().start_max; })
        .def_property_readonly("fold_free", [](const LeastMaximumObject& o) { return o.result().fold_free; })
        .def_property_readonly("iterations", [](const LeastMaximumObject& o) { return o.result().iterations; })
        .def_property_readonly("branch_points",
                               [](const LeastMaximumObject& o) { return index_array(o.result().branch_points); });

    m.def("least_dilatation_map", &least_dilatation, py::arg("surface"), py::arg("constraints"),
          py::arg("minimize") = "dilatation", py::arg("power") = 128.0,
          (std::string("The extremal map, or, where parts of the boundary are free or minimize=\"maximum\", the map of "
                       "this mesh whose largest |μ| is least.\n\n") +
           kExtremalOptions)
              .c_str());

    m.def("least_maximum_map", &least_maximum, py::arg("surface"), py::arg("constraints"),
          (std::string("The map of this mesh whose largest |μ| is least (a local minimum near the start).\n\nFurther "
                       "options: power=128 of the last stage, newton_iterations=1000, newton_tolerance=1e-6.\n\n") +
           kExtremalOptions)
              .c_str());
    m.def(
        "free_parts",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary) {
            validate(boundary, surface->surface);
            return index_array(free_parts(surface->surface, boundary));
        },
        py::arg("surface"), py::arg("boundary"),
        "Boundary vertices that are free where every loop has some that are prescribed, two in all at least, else "
        "none.\n\nRaises BadBoundary.");
    m.def(
        "takes_least_maximum",
        [](const SurfacePtr& surface, const py::object& what, const std::string& minimize) {
            const ConstraintsObject object = constraints_of(what);
            validate(object.constraints, surface->surface);
            return takes_least_maximum(
                surface->surface, object.constraints,
                Keywords::choice<Least>("minimize", py::str(minimize),
                                        {{"dilatation", Least::dilatation}, {"maximum", Least::maximum}}));
        },
        py::arg("surface"), py::arg("constraints"), py::arg("minimize") = "dilatation",
        "Whether least_dilatation_map returns the map of least maximum.\n\nRaises BadBoundary, BadOption.");
}

}  // namespace beltrami::python
