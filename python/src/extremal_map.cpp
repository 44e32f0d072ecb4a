#include "extremal_map.h"

#include <chrono>
#include <cstdio>

#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/report/record_json.h>
#include <beltrami/teichmuller/certify.h>
#include <beltrami/teichmuller/extremal_between.h>
#include <beltrami/teichmuller/least_dilatation.h>

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

struct BetweenObject {
    ExtremalPtr plane;
    Places places;
    Positions positions;
    std::vector<int> partner;
};

struct CertificationObject {
    ExtremalPtr result;
    Certification numbers;  // without its map
};

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

BetweenObject between(const SurfacePtr& source, const SurfacePtr& target, const py::object& pairs,
                      const py::kwargs& given) {
    const Eigen::MatrixXi rows = whole_table(pairs, "pairs", 2);
    std::vector<std::array<int, 2>> list;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) list.push_back({rows(i, 0), rows(i, 1)});
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
        object.plane = std::make_shared<ExtremalObject>(source, std::move(result.plane), seconds() - start);
        object.places.points = std::move(result.places);
        object.positions = std::move(result.positions);
        object.partner = std::move(result.target.correspondence.partner);
        return object;
    });
}

CertificationObject certified(const SurfacePtr& surface, const py::object& what, double gap, const py::kwargs& given) {
    const ConstraintsObject object = constraints_of(what);
    Interruption interruption;
    ExtremalOptions options;
    CertifyOptions limits;
    Keywords keywords(given);
    take_extremal(keywords, interruption, {surface.get(), object.target.get()}, options);
    keywords.take("most_triangles", limits.most_triangles);
    keywords.take("most_refinements", limits.most_refinements);
    keywords.take("least_progress", limits.least_progress);
    keywords.take("most_proof_triangles", limits.most_proof_triangles);
    keywords.finish();
    const double start = seconds();
    return without_lock(interruption, [&] {
        CertificationObject made;
        made.numbers = certify(surface->surface, object.constraints, gap, options, limits);
        made.result = std::make_shared<ExtremalObject>(surface, std::move(made.numbers.result), seconds() - start);
        made.numbers.result = {};
        return made;
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

    py::class_<LeastMaximumObject, PlanarMap, std::shared_ptr<LeastMaximumObject>>(
        m, "LeastMaximumMap", "The map of this mesh whose largest |μ| is least.")
        .def_property_readonly("start_max", [](const LeastMaximumObject& o) { return o.result().start_max; })
        .def_property_readonly("fold_free", [](const LeastMaximumObject& o) { return o.result().fold_free; })
        .def_property_readonly("iterations", [](const LeastMaximumObject& o) { return o.result().iterations; })
        .def_property_readonly("branch_points",
                               [](const LeastMaximumObject& o) { return index_array(o.result().branch_points); });

    m.def("extremal_map", &extremal, py::arg("surface"), py::arg("constraints"),
          (std::string(
               "The extremal quasiconformal (Teichmüller) map under constraints, by Hamilton's iteration.\n\n"
               "constraints: a BoundaryCondition (all boundary values are prescribed), a TargetDomain or Surface "
               "(every boundary loop slides onto it), or Constraints. Charts that the surface keeps are used.\n\n") +
           kExtremalOptions +
           "\n\nSources: Reich & Strebel 1974; Weber, Myles & Zorin 2012 and Ng, Gu & Lui 2014 solve the same problems "
           "otherwise.")
              .c_str());
    m.def("least_dilatation_map", &least_dilatation, py::arg("surface"), py::arg("constraints"),
          py::arg("minimize") = "dilatation", py::arg("power") = 128.0,
          (std::string("The extremal map, or, where parts of the boundary are free or minimize=\"maximum\", the map of "
                       "this mesh whose largest |μ| is least.\n\n") +
           kExtremalOptions)
              .c_str());

    py::class_<BetweenObject>(m, "ExtremalMapBetween", "An extremal map onto a surface whose boundary is prescribed.")
        .def_readonly("plane", &BetweenObject::plane, "The ExtremalMap to the target's circle domain")
        .def_readonly("places", &BetweenObject::places, "#V Places on the target's faces")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const BetweenObject&>().positions, self); },
            "#V×3 (or ×2, as the target has them) their positions")
        .def_readonly("partner", &BetweenObject::partner, "Of every boundary loop of the source, that of the target")
        .def("__repr__",
             [](const BetweenObject& o) { return "<beltrami map onto a surface: " + o.plane->summary() + ">"; });
    m.def("extremal_map_between", &between, py::arg("source"), py::arg("target"), py::arg("pairs"),
          (std::string(
               "The extremal map of a surface onto another one with prescribed boundary correspondence.\n\n"
               "pairs: n×2 (boundary vertex of the source, of the target), at least one on every loop; arc length "
               "between them. Also outer_loop, turns, waypoints as of Constraints.\n\n") +
           kExtremalOptions)
              .c_str());

    py::class_<CertificationObject>(m, "Certification", "An extremal map with a bracket of K*.")
        .def_readonly("result", &CertificationObject::result, "The ExtremalMap, with the best bounds of all meshes")
        .def_property_readonly(
            "K_lower", [](const CertificationObject& o) { return o.result->result().K_lower_proved; },
            "K* ≥ this, proved up to rounding")
        .def_property_readonly(
            "K_upper", [](const CertificationObject& o) { return o.numbers.K_upper; },
            "K* ≤ this, proved up to rounding; infinite where there is none")
        .def_property_readonly(
            "gap", [](const CertificationObject& o) { return o.numbers.gap; }, "K_upper/K_lower − 1")
        .def_property_readonly("estimated_gap", [](const CertificationObject& o) { return o.numbers.estimated_gap; })
        .def_property_readonly("reached", [](const CertificationObject& o) { return o.numbers.reached; })
        .def_property_readonly("reason", [](const CertificationObject& o) { return o.numbers.reason; })
        .def_property_readonly("refinements", [](const CertificationObject& o) { return o.numbers.refinements; })
        .def("__repr__", [](const CertificationObject& o) {
            return "<beltrami.Certification: K* in [" + std::to_string(o.result->result().K_lower_proved) + ", " +
                   std::to_string(o.numbers.K_upper) + "]>";
        });
    m.def("certify", &certified, py::arg("surface"), py::arg("constraints"), py::arg("gap") = 0.01,
          (std::string(
               "The extremal map, with a proof that K_upper is at most (1 + gap) K_lower, or a reason why there is "
               "none.\n\nFurther options: most_triangles=300000, most_refinements=6, least_progress=0.1, "
               "most_proof_triangles=12000.\n\n") +
           kExtremalOptions)
              .c_str());
    m.def(
        "bounds_of_map",
        [](const SurfacePtr& surface, const py::object& map) {
            const Eigen::VectorXcd images = map_of(*surface, map);
            return without_lock([&] { return bounds_of_map(surface->surface, images).bounds; });
        },
        py::arg("surface"), py::arg("map"),
        "Lower bounds of K of every map with the boundary values of a map from anywhere, proved up to rounding, and "
        "what "
        "the map attains: a certificate for the maps of others.\n\nRaises BadMesh unless the surface is a disk; "
        "BadBoundary if the boundary's image is not a simple counter-clockwise polygon.");
}

}  // namespace beltrami::python
