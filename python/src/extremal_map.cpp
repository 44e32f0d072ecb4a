#include "extremal_map.h"

#include <chrono>
#include <cstdio>

#include <beltrami/report/record_json.h>

#include "module.h"

namespace beltrami::python {

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

const char* const kExtremalOptions =
    "Options: tolerance=0 (0: what suits), max_iterations=60, anderson_window=5, growth=1e-5, cluster_count=1500, "
    "start=None (#V map to begin with), split_prescribed=True, evening=\"where_needed\" | \"always\" | \"never\", "
    "chart_metric=None | True | False, slack=0 (edges that boundary points may move), remove_folds=True, sharpen=None "
    "(subdivisions for a better bound; negative: none), prove=None | True | False, space=\"automatic\" | "
    "\"projection\" "
    "| \"laurent\" | \"one_form_squares\", coarse_start=True, target_edge_length=0, start_turns=[], progress=None: "
    "called as progress(iteration, k), False stops (Cancelled).\n\n"
    "Ctrl-C stops the solve. Raises BadMesh, BadBoundary, BadOption, NotSolved, Cancelled.";

void take_extremal(Keywords& keywords, Interruption& interruption, std::vector<const SurfaceObject*> surfaces,
                   ExtremalOptions& options) {
    keywords.iteration(interruption, options);
    keywords.take("growth", options.growth);
    keywords.take("cluster_count", options.cluster_count);
    if (const py::object start = keywords.taken("start"); start && !start.is_none())
        options.start = complex_numbers(start, "start");
    keywords.take("split_prescribed", options.split_prescribed);
    using Evening = ExtremalOptions::Evening;
    keywords.choose<Evening>(
        "evening", options.evening,
        {{"where_needed", Evening::where_needed}, {"always", Evening::always}, {"never", Evening::never}});
    keywords.take("chart_metric", options.chart_metric);
    keywords.take("slack", options.slack);
    keywords.take("remove_folds", options.remove_folds);
    keywords.take("sharpen", options.sharpen);
    keywords.take("prove", options.prove);
    using Space = ExtremalOptions::Space;
    keywords.choose<Space>("space", options.space,
                           {{"automatic", Space::automatic},
                            {"projection", Space::projection},
                            {"laurent", Space::laurent},
                            {"one_form_squares", Space::one_form_squares}});
    keywords.take("coarse_start", options.coarse_start);
    keywords.take("target_edge_length", options.target_edge_length);
    keywords.take("start_turns", options.start_turns);
    for (const SurfaceObject* surface : surfaces)
        if (surface) options.shapes.push_back(&surface->shape);
}

ExtremalObject::ExtremalObject(const SurfacePtr& source, ExtremalMap result, double seconds)
    : PlanarMap(source, result.split ? make_surface(result.split->mesh, result.split->metric) : source),
      result_(std::move(result)),
      seconds_(seconds) {}

Record ExtremalObject::record() const {
    Record record;
    record.command = "map";
    record.source = source_record(source()->surface);
    record.map = map_record(result_);
    record.solve = solve_record(result_, seconds_);
    record_findings(result_, source()->vertex_count(), record);
    if (!result_.loops.empty()) {
        record.onto = onto_record(result_, "");
        record.homotopy.reset();
        record.corners.reset();
    }
    return record;
}

std::vector<PageMap> ExtremalObject::other_pages() const {
    std::vector<PageMap> pages;
    const auto add = [&](const char* name, const Eigen::VectorXcd& map) {
        if (map.size() != surface()->vertex_count()) return;
        pages.push_back(
            {name, plane_positions(map), beltrami::distortion(surface()->surface.operators, map).face_abs_mu});
    };
    if (result_.loops.empty()) {
        add("harmonic", result_.harmonic);
    } else {
        add("start", result_.start);
    }
    return pages;
}

std::optional<PageDifferential> ExtremalObject::differential() const {
    if (result_.phi.size() == 0 || result_.differential.zero() || surface()->surface.metric) return {};
    return page_differential(surface()->surface, result_.phi, result_.differential);
}

std::string ExtremalObject::summary() const {
    char text[200];
    std::snprintf(text, sizeof text, "extremal, K %.5f (bounds %.5f, faces %.5f), %s after %d iterations, %zu flipped",
                  result_.K, result_.K_lower, result_.K_max, to_string(result_.termination), result_.iterations,
                  result_.distortion.flipped.size());
    return text;
}

namespace {

ExtremalPtr extremal(const SurfacePtr& surface, const py::object& what, const py::kwargs& given) {
    const ConstraintsObject object = constraints_of(what);
    Interruption interruption;
    ExtremalOptions options;
    Keywords keywords(given);
    take_extremal(keywords, interruption, {surface.get(), object.target.get()}, options);
    keywords.finish();
    const double start = seconds();
    return without_lock(interruption, [&] {
        ExtremalMap result = extremal_map(surface->surface, object.constraints, options);
        return std::make_shared<ExtremalObject>(surface, std::move(result), seconds() - start);
    });
}

template <class T>
py::object places_or_none(const std::vector<T>& places) {
    if (places.empty()) return py::none();
    return py::cast(Places{places});
}

}  // namespace

void bind_extremal(py::module_& m) {
    py::class_<Iteration>(m, "Iteration", "One iteration in the history of an extremal map.")
        .def_readonly("k", &Iteration::k)
        .def_readonly("change", &Iteration::change, "of the direction of φ")
        .def_readonly("functions", &Iteration::functions, "dimension of the space of differentials")
        .def_readonly("largest", &Iteration::largest, "|μ| of the map")
        .def("__repr__", [](const Iteration& i) { return "<beltrami.Iteration: k " + std::to_string(i.k) + ">"; });
    py::class_<Bound>(m, "Bound", "A statement about a dilatation K.")
        .def_property_readonly("kind", [](const Bound& bound) { return std::string(to_string(bound.kind)); })
        .def_readonly("K", &Bound::K)
        .def_property_readonly("of", [](const Bound& bound) { return std::string(to_string(bound.of)); })
        .def_readonly("rigorous", &Bound::rigorous, "A proof up to floating point and quadrature; else an estimate")
        .def("__repr__", [](const Bound& bound) {
            return std::string("<beltrami.Bound: ") + to_string(bound.kind) + ", K " + std::to_string(bound.K) +
                   (bound.rigorous ? ", proved>" : ">");
        });

    const auto field = [](auto member) {
        return [member](const ExtremalObject& object) { return object.result().*member; };
    };
    const auto array = [](auto member) {
        return [member](const py::object& self) {
            return view(self.cast<const ExtremalObject&>().result().*member, self);
        };
    };
    py::class_<ExtremalObject, PlanarMap, ExtremalPtr>(
        m, "ExtremalMap", "The map of least dilatation among all that obey the constraints, and how good it is.")
        .def_property_readonly("k", field(&ExtremalMap::k), "An estimate of k*")
        .def_property_readonly("K", field(&ExtremalMap::K), "An estimate of K* = (1+k*)/(1−k*)")
        .def_property_readonly("K_lower", field(&ExtremalMap::K_lower),
                               "The largest lower bound of K*, proved or estimated; 1 if there is none")
        .def_property_readonly("K_lower_proved", field(&ExtremalMap::K_lower_proved),
                               "The largest that is a proof up to floating point and quadrature")
        .def_property_readonly("K_upper", field(&ExtremalMap::K_upper), "Where boundaries slide")
        .def_property_readonly("bounds", field(&ExtremalMap::bounds))
        .def_property_readonly("phi", array(&ExtremalMap::phi),
                               "#S values of the quadratic differential φ at the samples, in their frames")
        .def_property_readonly("harmonic", array(&ExtremalMap::harmonic),
                               "#V the harmonic map with the boundary values; empty where boundaries slide")
        .def_property_readonly("start", array(&ExtremalMap::start), "#V the map from which the iteration began")
        .def_property_readonly(
            "termination", [](const ExtremalObject& o) { return std::string(to_string(o.result().termination)); },
            "\"converged\", \"iteration_limit\", \"not_teichmuller\", \"below_bound\" or \"unconfirmed\"")
        .def_property_readonly(
            "iterations", [](const ExtremalObject& o) { return o.result().iterations; }, "Linear solves")
        .def_property_readonly("factorizations", [](const ExtremalObject& o) { return o.result().factorizations; })
        .def_property_readonly("seconds", &ExtremalObject::seconds)
        .def_property_readonly("history", field(&ExtremalMap::history))
        .def_property_readonly("corners", field(&ExtremalMap::corners))
        .def_property_readonly("boundary_residual", field(&ExtremalMap::boundary_residual))
        .def_property_readonly("evened", field(&ExtremalMap::evened))
        .def_property_readonly("folds_removed", field(&ExtremalMap::folds_removed))
        .def_property_readonly(
            "turns",
            [](const ExtremalObject& o) {
                py::dict turns;
                for (const HoleTurns& hole : o.result().homotopy.holes) turns[py::int_(hole.loop)] = hole.turns;
                return turns;
            },
            "Turns of every hole's loop against the outer one, where boundary values are prescribed")
        .def_property_readonly("dimension", field(&ExtremalMap::dimension),
                               "Of the differentials, where boundaries slide")
        .def_property_readonly(
            "loops",
            [](const ExtremalObject& o) {
                py::list loops;
                for (const LoopOnto& loop : o.result().loops)
                    loops.append(py::make_tuple(loop.loop, loop.curve, loop.parameters));
                return loops;
            },
            "Where boundaries slide: (loop, curve, arc length there of every vertex of the loop)")
        .def_property_readonly(
            "places", [](const ExtremalObject& o) { return places_or_none(o.result().places); },
            "Onto a surface: #V Places on its faces")
        .def_property_readonly("positions", array(&ExtremalMap::positions),
                               "#V×3 (or ×2, as the target has them) their positions");

    m.def("extremal_map", &extremal, py::arg("surface"), py::arg("constraints"),
          (std::string(
               "The extremal quasiconformal (Teichmüller) map under constraints, by Hamilton's iteration.\n\n"
               "constraints: a BoundaryCondition (all boundary values are prescribed), a TargetDomain or Surface "
               "(every boundary loop slides onto it), or Constraints. Charts that the surface keeps are used.\n\n") +
           kExtremalOptions +
           "\n\nSources: Reich & Strebel 1974; Weber, Myles & Zorin 2012 and Ng, Gu & Lui 2014 solve the same problems "
           "otherwise.")
              .c_str());
}

}  // namespace beltrami::python
