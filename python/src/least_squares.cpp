#include <beltrami/space/corner_elements.h>
#include <beltrami/space/uniform_map.h>

#include "extremal_map.h"
#include "module.h"
#include "space_map.h"

namespace beltrami::python {

namespace {

/// A problem that owns what it refers to.
struct LeastSquaresObject {
    SurfacePtr surface;
    CornerElements elements;
    LeastSquaresMap problem;
    std::mutex mutex;

    LeastSquaresObject(const SurfacePtr& of, CornerElements with, Positions places, std::vector<char> fixed,
                       Preserve preserve)
        : surface(of),
          elements(std::move(with)),
          problem(surface->surface.mesh, elements, std::move(places), std::move(fixed), preserve) {}

    /// #S, from #S or #F. @throw Error bad_option
    Eigen::VectorXcd coefficient(const py::object& mu, const char* name) const {
        if (mu.is_none()) return Eigen::VectorXcd::Zero(elements.operators.sample_count());
        Eigen::VectorXcd result = complex_numbers(mu, name);
        if (result.size() == elements.operators.face_count && result.size() != elements.operators.sample_count())
            result = face_values_at_samples(elements.operators, result);
        if (result.size() != elements.operators.sample_count())
            throw Error(Cause::bad_option, std::string(name) + " is not one number for each face, or sample");
        std::vector<int> bad;
        for (Eigen::Index s = 0; s < result.size(); ++s)
            if (!(std::abs(result[s]) < 1)) bad.push_back(elements.operators.faces[static_cast<std::size_t>(s)]);
        if (!bad.empty())
            throw Error(Cause::bad_option,
                        std::string(name) + ": |mu| of face " + std::to_string(bad[0]) + " is not below 1",
                        "there is no such map", {Things::faces, bad});
        return result;
    }
};
using LeastSquaresPtr = std::shared_ptr<LeastSquaresObject>;

CornerElements elements_of(const Mesh& mesh, const py::object& corners) {
    if (corners.is_none()) return corner_elements(mesh);
    const Positions at = points(corners, "reference");
    if (at.rows() != mesh.faces.corner_count())
        throw Error(Cause::bad_option, "reference is not one point for each corner of a face");
    return corner_elements(mesh, at);
}

LeastSquaresPtr problem_of(const SurfacePtr& source, const py::object& fixed, const py::object& places,
                           const std::string& preserve, const py::object& reference) {
    const SurfacePtr surface = in_space(source);
    const Mesh& mesh = surface->surface.mesh;
    const std::vector<int> list = vertex_list(fixed, "fixed", mesh.vertex_count());
    Positions at = Positions::Zero(mesh.vertex_count(), 3);
    std::vector<char> held(static_cast<std::size_t>(mesh.vertex_count()), 0);
    if (!list.empty()) {
        const Positions given = points_of(places, "places", static_cast<int>(list.size()), 3);
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (held[static_cast<std::size_t>(list[i])])
                throw Error(Cause::bad_option, "vertex " + std::to_string(list[i]) + " is fixed twice", {},
                            {Things::vertices, {list[i]}});
            held[static_cast<std::size_t>(list[i])] = 1;
            at.row(list[i]) = given.row(static_cast<Eigen::Index>(i));
        }
    }
    const auto what = Keywords::choice<Preserve>(
        "preserve", py::str(preserve),
        {{"nothing", Preserve::nothing}, {"normals", Preserve::normals}, {"area", Preserve::area}});
    CornerElements elements = elements_of(mesh, reference);
    return without_lock([&] {
        return std::make_shared<LeastSquaresObject>(surface, std::move(elements), std::move(at), std::move(held), what);
    });
}

Positions places_in(const LeastSquaresObject& o, const py::object& map) {
    return points_of(map, "map", o.surface->vertex_count(), 3);
}

/// Of a map in space by the QC iteration.
class UniformObject final : public SpaceMap {
  public:
    UniformObject(const SurfacePtr& source, UniformMap found, Distortion distortion, Record record)
        : SpaceMap(source, "uniform", found.map, std::move(distortion), std::move(record)), found_(std::move(found)) {}
    const UniformMap& found() const { return found_; }

  private:
    UniformMap found_;
};
using UniformPtr = std::shared_ptr<UniformObject>;

UniformPtr uniform(const LeastSquaresPtr& o, const py::kwargs& given) {
    Interruption interruption;
    UniformOptions options;
    Keywords keywords(given);
    keywords.take("max_iterations", options.max_iterations);
    keywords.take("tolerance", options.tolerance);
    keywords.take("line_search", options.line_search);
    keywords.take("smoothing_passes", options.smoothing_passes);
    keywords.progress(interruption, options.progress);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        const std::lock_guard lock(o->mutex);
        UniformMap found = uniform_map(o->problem, o->surface->surface.mesh, options);
        Mesh image = o->surface->surface.mesh;
        image.positions = found.map;
        Distortion measured = distortion(o->elements.operators, image.positions, vertex_normals(image));
        Record record = space_record(o->surface, "flatten", map_record(measured), {});
        record.solve =
            solve_of(found.solves, o->problem.factorization_count(),
                     found.converged ? Termination::converged : Termination::iteration_limit, seconds() - begun);
        return std::make_shared<UniformObject>(o->surface, std::move(found), std::move(measured), std::move(record));
    });
}

}  // namespace

void bind_least_squares(py::module_& m) {
    py::class_<CornerElements>(
        m, "CornerElements", "The elements on which maps into space are measured: the corner triangles of every face.")
        .def_property_readonly(
            "sample_count", [](const CornerElements& e) { return e.operators.sample_count(); },
            "#S: one a triangle, n an n-gon")
        .def_property_readonly(
            "faces", [](const CornerElements& e) { return index_array(e.operators.faces); }, "#S face of every sample")
        .def_property_readonly(
            "weights", [](const CornerElements& e) { return number_array(e.operators.weights); }, "#S areas")
        .def_property_readonly(
            "edge_direction", [](const CornerElements& e) { return e.edge_direction; },
            "#corners: of the edge to the next corner, in the element's frame, of length 1")
        .def(
            "d_z", [](const CornerElements& e) { return e.operators.d_z(); },
            "∂ as a sparse #S×#V matrix (scipy.sparse)")
        .def(
            "d_zbar", [](const CornerElements& e) { return e.operators.d_zbar(); },
            "∂̄ as a sparse #S×#V matrix (scipy.sparse)")
        .def("__repr__", [](const CornerElements& e) {
            return "<beltrami.CornerElements: " + std::to_string(e.operators.sample_count()) + " samples>";
        });
    m.def(
        "corner_elements",
        [](const SurfacePtr& surface, const py::object& corners) {
            return elements_of(surface->surface.mesh, corners);
        },
        py::arg("surface"), py::arg("reference") = py::none(),
        "The elements of a mesh by its own shape, or by the metric in which every face has the shape of its points in "
        "reference (#corners×2 or ×3).\n\nRaises BadMesh naming faces without area.");
    m.def(
        "corner_normals", [](const SurfacePtr& surface) { return corner_normals(surface->surface.mesh); },
        py::arg("surface"), "#S×3 unit normals of the corner triangles.");
    m.def(
        "face_means",
        [](const CornerElements& e, const py::object& samples) {
            return face_means(e.operators, complex_numbers(samples, "samples", e.operators.sample_count(), "samples"));
        },
        py::arg("elements"), py::arg("samples"), "#F area-weighted means of #S values.\n\nRaises BadOption.");
    m.def(
        "face_values_at_samples",
        [](const CornerElements& e, const py::object& faces) {
            return face_values_at_samples(e.operators,
                                          complex_numbers(faces, "faces", e.operators.face_count, "faces"));
        },
        py::arg("elements"), py::arg("faces"), "#S: the value of its face at every sample.\n\nRaises BadOption.");

    py::class_<LeastSquaresObject, LeastSquaresPtr>(
        m, "LeastSquaresMap",
        "The least-squares quasiconformal maps of a surface into space (Gruber, Aulisa 2022, Algorithms 1 and 2): one "
        "problem, any number of coefficients.")
        .def(py::init(&problem_of), py::arg("surface"), py::arg("fixed") = py::list(), py::arg("places") = py::list(),
             py::arg("preserve") = "nothing", py::arg("reference") = py::none(),
             "fixed: n vertices, places: their n×3 places. preserve: \"nothing\", \"normals\" (vertices move in their "
             "tangent planes) or \"area\" (it stays to first order). reference: #corners×2 or ×3 shapes of the faces "
             "(None: their own).\n\nRaises BadBoundary where the map would collapse to a point, BadOption, BadMesh.")
        .def(
            "solve",
            [](const LeastSquaresPtr& o, const py::object& mu) {
                const Eigen::VectorXcd samples = o->coefficient(mu, "mu");
                return without_lock([&] {
                    const std::lock_guard lock(o->mutex);
                    return o->problem.solve(samples);
                });
            },
            py::arg("mu") = py::none(),
            "#V×3 of the map with a coefficient in the elements' frames, #S or #F, |μ| < 1 (None: 0).\n\nRaises "
            "BadOption naming faces, NotSolved.")
        .def(
            "gradient",
            [](const LeastSquaresPtr& o, const py::object& map, const py::object& mu) {
                return o->problem.gradient(o->coefficient(mu, "mu"), places_in(*o, map));
            },
            py::arg("map"), py::arg("mu") = py::none(), "#V×3: half the gradient of the energy.")
        .def(
            "energy",
            [](const LeastSquaresPtr& o, const py::object& map, const py::object& mu) {
                return o->problem.energy(o->coefficient(mu, "mu"), places_in(*o, map));
            },
            py::arg("map"), py::arg("mu") = py::none(), "QC_μ of a map, #V×3.")
        .def(
            "best_step",
            [](const LeastSquaresPtr& o, const py::object& mu_from, const py::object& mu_to, const py::object& map) {
                return o->problem.best_step(o->coefficient(mu_from, "mu_from"), o->coefficient(mu_to, "mu_to"),
                                            places_in(*o, map));
            },
            py::arg("mu_from"), py::arg("mu_to"), py::arg("map"),
            "Part of the way from one coefficient to another, 0 … 1, on which the energy of a map is least.")
        .def_property_readonly(
            "elements", [](const LeastSquaresObject& o) { return o.elements; }, "CornerElements")
        .def_property_readonly("factorization_count",
                               [](const LeastSquaresObject& o) { return o.problem.factorization_count(); })
        .def("__repr__", [](const LeastSquaresObject& o) {
            return "<beltrami.LeastSquaresMap: " + std::to_string(o.surface->vertex_count()) + " vertices>";
        });

    py::class_<UniformObject, SpaceMap, UniformPtr>(m, "UniformMap", "A map into space by the QC iteration.")
        .def_property_readonly(
            "first", [](const py::object& self) { return view(self.cast<const UniformObject&>().found().first, self); },
            "#V×3 the least-squares conformal map with which it began")
        .def_property_readonly(
            "wanted",
            [](const py::object& self) { return view(self.cast<const UniformObject&>().found().wanted, self); },
            "#F coefficient of the last solve")
        .def_property_readonly("converged", [](const UniformObject& o) { return o.found().converged; });
    m.def(
        "uniform_map", &uniform, py::arg("problem"),
        "The QC iteration (Gruber and Aulisa 2022, Algorithm 3, corrected) of a LeastSquaresMap: |μ| of every face is "
        "replaced by the mean of all, its argument smoothed. Folds are not excluded, and a limit need not be "
        "extremal.\n\nOptions: max_iterations=40, tolerance=1e-3, line_search=False, smoothing_passes=1, "
        "progress=None.\n\nRaises BadOption, NotSolved, Cancelled.");
    m.def(
        "smoothed_over_edges",
        [](const CornerElements& elements, const SurfacePtr& surface, const py::object& mu, int passes) {
            if (elements.operators.face_count != surface->surface.mesh.face_count() ||
                elements.edge_direction.size() != surface->surface.mesh.faces.corner_count())
                throw Error(Cause::bad_option, "the elements are those of another surface");
            if (passes < 0 || passes > 10000) throw Error(Cause::bad_option, "passes are not from 0 to 10000");
            return smoothed_over_edges(elements, surface->surface.mesh,
                                       complex_numbers(mu, "mu", surface->surface.mesh.face_count(), "faces"), passes);
        },
        py::arg("elements"), py::arg("surface"), py::arg("mu"), py::arg("passes") = 1,
        "Mean |μ| with the argument smoothed over the edges: #F from #F, in the frames of the elements.\n\nRaises "
        "BadOption.");
}

}  // namespace beltrami::python
