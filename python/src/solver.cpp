#include <beltrami/teichmuller/extremal_solver.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A solver that owns what it refers to.
class SolverObject {
  public:
    SolverObject(const SurfacePtr& surface, const py::object& constraints, const py::kwargs& given)
        : surface_(surface), constraints_(constraints_of(constraints)) {
        ExtremalOptions options;
        Keywords keywords(given);
        take_extremal(keywords, interruption_, {surface_.get(), constraints_.target.get()}, options);
        keywords.finish();
        solver_ = without_lock(interruption_, [&] {
            return std::make_unique<ExtremalSolver>(surface_->surface, constraints_.constraints, options);
        });
    }

    py::tuple update(const py::object& images, int max_iterations) {
        const std::vector<Complex> list = complex_list(images, "images");
        Eigen::VectorXcd map;
        double k = 0;
        bool converged = false;
        int flipped = 0;
        without_lock(interruption_, [&] {
            const std::lock_guard lock(mutex_);
            const ExtremalSolver::Update update = solver_->update(list, max_iterations);
            map = update.map;
            k = update.k;
            converged = update.converged;
            flipped = update.flipped;
            return 0;
        });
        return py::make_tuple(std::move(map), k, converged, flipped);
    }

    ExtremalPtr solve() {
        const double start = seconds();
        return without_lock(interruption_, [&] {
            const std::lock_guard lock(mutex_);
            ExtremalMap result = solver_->solve();
            return std::make_shared<ExtremalObject>(surface_, std::move(result), seconds() - start);
        });
    }

    std::vector<int> vertices() const { return constraints_.constraints.prescribed.vertices; }

  private:
    SurfacePtr surface_;
    ConstraintsObject constraints_;
    Interruption interruption_;
    std::mutex mutex_;
    std::unique_ptr<ExtremalSolver> solver_;
};

}  // namespace

void bind_solver(py::module_& m) {
    py::class_<SolverObject>(
        m, "ExtremalSolver",
        "The extremal map of one source for constraints that change: pins are dragged, the boundary "
        "is moved, and the map follows. Charts, analysis and differentials are kept.")
        .def(py::init([](const SurfacePtr& surface, const py::object& constraints, const py::kwargs& given) {
                 return std::make_unique<SolverObject>(surface, constraints, given);
             }),
             py::arg("surface"), py::arg("constraints"), kExtremalOptions)
        .def_property_readonly(
            "vertices", [](const SolverObject& o) { return index_array(o.vertices()); },
            "The prescribed vertices, in the order of the images of update")
        .def("update", &SolverObject::update, py::arg("images"), py::arg("max_iterations") = 4,
             "Moves the prescribed vertices and iterates a few times from where the solver stands.\n\nimages: one "
             "complex "
             "number for each of vertices (or n×2). Returns the map (#V complex), k, whether it has converged, and the "
             "number of flipped samples.\n\nRaises BadBoundary for images that no one-to-one map has; the solver then "
             "stands where it stood.")
        .def("solve", &SolverObject::solve, "Iterates until all has settled, finishes and measures: an ExtremalMap.")
        .def("__repr__", [](const SolverObject& o) {
            return "<beltrami.ExtremalSolver: " + std::to_string(o.vertices().size()) + " vertices prescribed>";
        });
}

}  // namespace beltrami::python
