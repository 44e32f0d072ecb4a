#include <beltrami/evening/even_dilatation.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/solve/quasiconformal_map.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A BoundaryCondition's, or #V numbers 0, 1, 2.
std::vector<Freedom> freedoms_of(const SurfacePtr& surface, const py::object& object) {
    if (py::isinstance<BoundaryCondition>(object)) {
        const auto& boundary = object.cast<const BoundaryCondition&>();
        validate(boundary, surface->surface);
        return freedoms(boundary, surface->surface);
    }
    std::vector<Freedom> result;
    for (const int number : whole_numbers(object, "freedoms")) {
        if (number < 0 || number > 2) throw Error(Cause::bad_option, "a freedom is 0 (free), 1 (sliding) or 2 (fixed)");
        result.push_back(static_cast<Freedom>(number));
    }
    if (static_cast<int>(result.size()) != surface->vertex_count())
        throw Error(Cause::bad_option, "freedoms are not one for each vertex");
    return result;
}

py::array freedom_array(const std::vector<Freedom>& freedoms) {
    std::vector<int> numbers;
    for (const Freedom freedom : freedoms) numbers.push_back(static_cast<int>(freedom));
    return index_array(numbers);
}

void require_finite(const Eigen::VectorXcd& values, const char* name) {
    if (!values.allFinite()) throw Error(Cause::bad_option, std::string(name) + " has numbers that are not finite");
}

/// A solver with the surface that it refers to, and what was last asked of it.
class LinearObject {
    /// What needs a factorisation.
    template <class Body>
    auto guarded(const Body& body) {
        return without_lock([&] {
            const std::lock_guard lock(mutex_);
            if (!factorized_) throw Error(Cause::bad_option, "nothing is factorised yet", "call factorize first");
            return body();
        });
    }

  public:
    LinearObject(const SurfacePtr& surface, const py::object& freedoms, int expected_factorizations)
        : surface_(surface) {
        std::vector<Freedom> list = freedoms_of(surface, freedoms);
        slides_ = std::find(list.begin(), list.end(), Freedom::sliding) != list.end();
        if (expected_factorizations < 1) throw Error(Cause::bad_option, "expected_factorizations is below 1");
        solver_ = without_lock([&] {
            return std::make_unique<BeltramiSolver>(surface_->surface, std::move(list), expected_factorizations);
        });
    }

    void factorize(const py::object& nu, const py::object& directions, const py::object& extra_diagonal) {
        const Eigen::VectorXcd coefficient = coefficient_of(nu);
        const Ways ways = ways_of(directions, extra_diagonal);
        without_lock([&] {
            const std::lock_guard lock(mutex_);
            factorized_ = false;
            solver_->factorize(coefficient, ways.directions, ways.extra_diagonal);
            factorized_ = true;
            last_ = coefficient;
            return 0;
        });
    }

    Eigen::VectorXcd solve(const py::object& start, const py::object& offset) {
        const Eigen::VectorXcd from = start_of(start, "start");
        const std::optional<Eigen::VectorXcd> r = offset.is_none() ? std::nullopt : std::optional(samples(offset));
        return guarded([&] { return r ? solver_->solve(from, *r) : solver_->solve(from); });
    }

    Eigen::MatrixXcd solve_offsets(const py::object& offsets) {
        const Eigen::MatrixXcd columns = complex_table(offsets, "offsets", surface_->sample_count());
        if (columns.cols() == 0) throw Error(Cause::bad_option, "offsets has no columns");
        if (!columns.allFinite()) throw Error(Cause::bad_option, "offsets has numbers that are not finite");
        return guarded([&] { return solver_->solve_offsets(columns); });
    }

    Eigen::VectorXd solve_poisson(const py::object& load) {
        const Eigen::VectorXd list = real_numbers(load, "load");
        if (list.size() != surface_->vertex_count() || !list.allFinite())
            throw Error(Cause::bad_option, "load is not one finite number for each vertex");
        return guarded([&] {
            if (!solver_->decoupled() || (last_.array() != 0.0).any())
                throw Error(Cause::bad_option,
                            "solve_poisson needs every boundary vertex fixed and a factorisation of the coefficient 0");
            return solver_->solve_poisson(list);
        });
    }

    Eigen::VectorXcd solve_near(const py::object& nu, const py::object& start, const py::object& guess,
                                double tolerance, const py::object& directions, const py::object& extra_diagonal) {
        const Eigen::VectorXcd coefficient = coefficient_of(nu), from = start_of(start, "start"),
                               first = start_of(guess, "guess");
        const Ways ways = ways_of(directions, extra_diagonal);
        if (!(tolerance > 0)) throw Error(Cause::bad_option, "tolerance is not positive");
        return guarded([&] {
            return slides_ ? solver_->solve_near(coefficient, ways.directions, ways.extra_diagonal, from, first,
                                                 std::max(tolerance, 1e-11))
                           : solver_->solve_near(coefficient, from, first, std::max(tolerance, 1e-11));
        });
    }

    Eigen::VectorXcd gradient(const py::object& f, const py::object& nu) {
        const Eigen::VectorXcd map = map_of(*surface_, f, "f");
        if (!nu.is_none()) {
            const Eigen::VectorXcd coefficient = coefficient_of(nu);
            const std::lock_guard lock(mutex_);
            return solver_->gradient(map, coefficient);
        }
        return guarded([&] { return solver_->gradient(map); });
    }

    const BeltramiSolver& solver() const { return *solver_; }

  private:
    struct Ways {
        Eigen::VectorXcd directions;
        Eigen::VectorXd extra_diagonal;
    };

    Eigen::VectorXcd samples(const py::object& values) const {
        Eigen::VectorXcd result = samples_of(*surface_, values, "offset");
        require_finite(result, "offset");
        return result;
    }
    Eigen::VectorXcd start_of(const py::object& values, const char* name) const {
        Eigen::VectorXcd result = map_of(*surface_, values, name);
        require_finite(result, name);
        return result;
    }
    Eigen::VectorXcd coefficient_of(const py::object& nu) const {
        Eigen::VectorXcd result = samples_of(*surface_, nu, "nu");
        require_coefficient(surface_->surface, result);
        return result;
    }
    Ways ways_of(const py::object& directions, const py::object& extra_diagonal) const {
        Ways ways;
        if (!directions.is_none()) ways.directions = start_of(directions, "directions");
        if (slides_ && ways.directions.size() == 0)
            throw Error(Cause::bad_option, "vertices slide, and there are no directions", "give #V of them");
        if (!extra_diagonal.is_none()) {
            ways.extra_diagonal = real_numbers(extra_diagonal, "extra_diagonal");
            if (ways.extra_diagonal.size() != surface_->vertex_count() || !ways.extra_diagonal.allFinite())
                throw Error(Cause::bad_option, "extra_diagonal is not one finite number for each vertex");
        }
        return ways;
    }
    SurfacePtr surface_;
    std::unique_ptr<BeltramiSolver> solver_;
    std::mutex mutex_;
    bool factorized_ = false, slides_ = false;
    Eigen::VectorXcd last_;
};

/// A map whose |μ| was evened out.
class EvenObject final : public PlanarMap {
  public:
    EvenObject(const SurfacePtr& surface, EvenDilatation result)
        : PlanarMap(surface, surface),
          result_(std::move(result)),
          distortion_(beltrami::distortion(surface->surface.operators, result_.map)) {}
    const Eigen::VectorXcd& map() const override { return result_.map; }
    const Distortion& distortion() const override { return distortion_; }
    const Warnings& warnings() const override { return warnings_; }
    std::string method() const override { return "evened"; }
    Record record() const override { return record_of(*this, "map"); }
    const EvenDilatation& result() const { return result_; }

  private:
    EvenDilatation result_;
    Distortion distortion_;
    Warnings warnings_;
};
using EvenPtr = std::shared_ptr<EvenObject>;

/// New φ and k of a function in Python: (φ, k), or None where the old ones stay.
CoefficientUpdate update_of(const SurfacePtr& surface, const std::optional<py::function>& function,
                            Interruption& interruption) {
    if (!function) return {};
    return [surface, function, &interruption](const Eigen::VectorXcd& map, Eigen::VectorXcd& phi, double& k) {
        bool updated = false;
        interruption.run([&] {
            const py::object answer = (*function)(map);
            if (answer.is_none()) return true;
            const auto [values, number] = value_of<std::pair<py::object, double>>(
                answer, "coefficient_update returns (phi, k), or None where the old ones stay");
            if (!(number >= 0 && number < 1)) throw py::value_error("k of coefficient_update is not from 0 to 1");
            phi = complex_numbers(values, "phi", surface->sample_count(), "samples");
            k = number;
            return updated = true;
        });
        return updated;
    };
}

EvenPtr evened(const SurfacePtr& surface, const py::object& freedoms, const py::object& start, double k,
               const py::object& phi, const std::optional<py::function>& coefficient_update, const py::kwargs& given) {
    const std::vector<Freedom> list = freedoms_of(surface, freedoms);
    const Eigen::VectorXcd from = map_of(*surface, start, "start");
    const Eigen::VectorXcd values = complex_numbers(phi, "phi", surface->sample_count(), "samples");
    if (!(k >= 0 && k < 1)) throw Error(Cause::bad_option, "k is not from 0 to below 1");
    if (!values.allFinite()) throw Error(Cause::bad_option, "phi has numbers that are not finite");
    Interruption interruption;
    EvenDilatationOptions options;
    Keywords keywords(given);
    keywords.take("steps", options.steps);
    keywords.take("anchor", options.anchor);
    keywords.take("outlier", options.outlier);
    keywords.take("most_patch_vertices", options.most_patch_vertices);
    keywords.progress(interruption, options.progress);
    keywords.finish();
    const CoefficientUpdate update = update_of(surface, coefficient_update, interruption);
    return without_lock(interruption, [&] {
        return std::make_shared<EvenObject>(surface,
                                            even_dilatation(surface->surface, list, from, k, values, update, options));
    });
}

void bind_conditions(py::module_& m) {
    m.def(
        "freedoms",
        [](const BoundaryCondition& boundary, const SurfacePtr& surface) {
            validate(boundary, surface->surface);
            return freedom_array(freedoms(boundary, surface->surface));
        },
        py::arg("boundary"), py::arg("surface"),
        "#V: what a vertex may do in a linear solve, 0 free, 1 sliding along a line, 2 fixed (as unreferenced ones "
        "are).\n\nRaises BadBoundary.");
    m.def(
        "prescribed_values",
        [](const BoundaryCondition& boundary, const SurfacePtr& surface) {
            validate(boundary, surface->surface);
            return prescribed_values(boundary, surface->surface);
        },
        py::arg("boundary"), py::arg("surface"),
        "#V: the prescribed images, a point of their line for vertices of lines, 0 elsewhere.\n\nRaises BadBoundary.");
    m.def(
        "line_directions",
        [](const BoundaryCondition& boundary, const SurfacePtr& surface) {
            validate(boundary, surface->surface);
            return line_directions(boundary, surface->surface);
        },
        py::arg("boundary"), py::arg("surface"),
        "#V unit directions of the lines, 0 elsewhere; empty if there are none.\n\nRaises BadBoundary.");
    m.def(
        "require_whole_boundary",
        [](const BoundaryCondition& boundary, const SurfacePtr& surface) {
            validate(boundary, surface->surface);
            require_whole_boundary(boundary, surface->surface);
        },
        py::arg("boundary"), py::arg("surface"), "Raises BadBoundary naming loops that are not wholly prescribed.");
    m.def(
        "require_coefficient",
        [](const SurfacePtr& surface, const py::object& mu) {
            require_coefficient(surface->surface, samples_of(*surface, mu, "mu"));
        },
        py::arg("surface"), py::arg("mu"), "Raises BadOption naming samples where |μ| is not below 1.");
}

}  // namespace

void bind_beltrami_solver(py::module_& m) {
    bind_conditions(m);
    py::class_<LinearObject>(m, "BeltramiSolver",
                             "The map with a given Beltrami coefficient ν: least Σ A |∂̄f − ν ∂f|²/(1−|ν|²). One "
                             "symbolic analysis, any number "
                             "of coefficients.")
        .def(py::init([](const SurfacePtr& surface, const py::object& freedoms, int expected_factorizations) {
                 return std::make_unique<LinearObject>(surface, freedoms, expected_factorizations);
             }),
             py::arg("surface"), py::arg("freedoms"), py::arg("expected_factorizations") = 1,
             "freedoms: a BoundaryCondition, or #V numbers 0 (free), 1 (sliding), 2 (fixed).\n\nRaises BadOption, "
             "BadBoundary.")
        .def("factorize", &LinearObject::factorize, py::arg("nu"), py::arg("directions") = py::none(),
             py::arg("extra_diagonal") = py::none(),
             "nu: #S or #F, |ν| < 1. directions: #V of the sliding vertices. extra_diagonal: #V added to the diagonal "
             "of "
             "sliding vertices.\n\nRaises BadOption, NotSolved naming vertices that are not constrained.")
        .def("solve", &LinearObject::solve, py::arg("start"), py::arg("offset") = py::none(),
             "#V by the last factorisation: fixed vertices keep their value of start (#V). offset: #S r of "
             "Σ A |∂̄f − ν ∂f + r|²/(1−|ν|²).\n\nRaises BadOption before the first factorize.")
        .def("solve_offsets", &LinearObject::solve_offsets, py::arg("offsets"),
             "#V×n solutions, 0 at fixed vertices, for offsets #S×n.")
        .def("solve_poisson", &LinearObject::solve_poisson, py::arg("load"),
             "#V: u with −Δu = load (#V integrals against hat functions), 0 at fixed vertices; after "
             "factorize(0).\n\nRaises BadOption.")
        .def("solve_near", &LinearObject::solve_near, py::arg("nu"), py::arg("start"), py::arg("guess"),
             py::arg("tolerance") = 1e-11, py::arg("directions") = py::none(), py::arg("extra_diagonal") = py::none(),
             "The map for a coefficient near the last one, by conjugate gradients from a guess (#V) where that takes "
             "few "
             "steps.\n\ntolerance: of the error, relative, in the energy norm; at least 1e-11.")
        .def("gradient", &LinearObject::gradient, py::arg("f"), py::arg("nu") = py::none(),
             "#V force on each vertex, D^H W D f with D = ∂̄ − ν∂; nu=None: the last one.")
        .def_property_readonly(
            "freedoms", [](const LinearObject& o) { return freedom_array(o.solver().freedoms()); }, "#V")
        .def_property_readonly(
            "decoupled", [](const LinearObject& o) { return o.solver().decoupled(); },
            "Whether real and imaginary parts are solved by themselves")
        .def_property_readonly("factorization_count",
                               [](const LinearObject& o) { return o.solver().factorization_count(); })
        .def("__repr__", [](const LinearObject& o) {
            return "<beltrami.BeltramiSolver: " + std::to_string(o.solver().freedoms().size()) + " vertices, " +
                   std::to_string(o.solver().factorization_count()) + " factorisations>";
        });
    m.def(
        "harmonic_map",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary) {
            validate(boundary, surface->surface);
            require_whole_boundary(boundary, surface->surface);
            return without_lock([&] { return harmonic_map(surface->surface, boundary); });
        },
        py::arg("surface"), py::arg("boundary"),
        "#V complex: the harmonic map of the surface's metric (Pinkall & Polthier 1993); the whole boundary is "
        "prescribed.\n\nRaises BadBoundary, NotSolved.");
    m.def(
        "least_squares_conformal_map",
        [](const SurfacePtr& surface, const std::optional<BoundaryCondition>& boundary) {
            const BoundaryCondition pins = boundary.value_or(BoundaryCondition());
            validate(pins, surface->surface);
            return without_lock([&] { return least_squares_conformal_map(surface->surface, pins); });
        },
        py::arg("surface"), py::arg("boundary") = py::none(),
        "#V complex: the least-squares conformal map (Lévy et al. 2002) with two pins or more, or none.\n\nRaises "
        "BadBoundary, NotSolved.");

    py::class_<EvenObject, PlanarMap, EvenPtr>(m, "EvenDilatation", "A map whose |μ| was evened out.")
        .def_property_readonly(
            "phi", [](const py::object& self) { return view(self.cast<const EvenObject&>().result().phi, self); },
            "#S of the last update")
        .def_property_readonly("k", [](const EvenObject& o) { return o.result().k; })
        .def_property_readonly("improved", [](const EvenObject& o) { return o.result().improved; })
        .def_property_readonly("start_energy", [](const EvenObject& o) { return o.result().start_energy; })
        .def_property_readonly("energy", [](const EvenObject& o) { return o.result().energy; })
        .def_property_readonly(
            "start_flipped", [](const EvenObject& o) { return o.result().start_flipped; },
            "Samples that were folded at the start")
        .def_property_readonly(
            "flipped", [](const EvenObject& o) { return o.result().flipped; }, "… and at the end");
    m.def(
        "even_dilatation", &evened, py::arg("surface"), py::arg("freedoms"), py::arg("start"), py::arg("k"),
        py::arg("phi"), py::arg("coefficient_update") = py::none(),
        "Evens |μ| out to the constant k of an almost extremal map, holding the phase of μ where |φ| is large.\n\n"
        "freedoms: a BoundaryCondition or #V numbers 0, 1, 2; what is not free keeps its value of start (#V). k: from "
        "0 to below 1. phi: #S. coefficient_update(map) returns (phi, k), or None.\n\nOptions: steps=3, anchor=0.07, "
        "outlier=0.07, most_patch_vertices=300, progress=None.\n\nRaises BadOption, BadBoundary, Cancelled.");
}

}  // namespace beltrami::python
