#include <beltrami/certificate/certificate.h>
#include <beltrami/certificate/pair_bound.h>
#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/certificate/verified_bracket.h>
#include <beltrami/hyperbolic/hyperbolic_surface.h>
#include <beltrami/report/record_json.h>
#include <beltrami/teichmuller/certify.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A bracket with the surface that it is of.
struct BracketObject {
    VerifiedBracket bracket;
    SurfacePtr surface;
};

/// Conditions that prescribe the whole boundary of a surface, and a map that obeys them.
struct Problem {
    Eigen::VectorXcd map;

    Problem(const SurfacePtr& surface, const BoundaryCondition& boundary, const py::object& given)
        : map(map_of(*surface, given)) {
        validate(boundary, surface->surface);
        require_open_component(surface->surface);
        require_whole_boundary(boundary, surface->surface);
        if (!map.allFinite()) throw Error(Cause::bad_option, "map has numbers that are not finite");
        std::vector<int> bad;
        const double size = map.size() > 0 ? map.cwiseAbs().maxCoeff() : 0;
        for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
            if (std::abs(map[boundary.vertices[i]] - boundary.images[i]) > 1e-6 * size)
                bad.push_back(boundary.vertices[i]);
        if (!bad.empty())
            throw Error(Cause::bad_boundary,
                        "the map does not take vertex " + std::to_string(bad[0]) + " where it is prescribed", {},
                        {Things::vertices, bad});
    }
};

void take_pairs(Keywords& keywords, PairBoundOptions& options) {
    keywords.take("most_steps", options.most_steps);
    keywords.take("pair_tolerance", options.tolerance);
    if (options.most_steps < 1 || !(options.tolerance > 0))
        throw Error(Cause::bad_option, "most_steps and pair_tolerance are to be positive");
}

std::vector<Bound> proved(const SurfacePtr& surface, const BoundaryCondition& boundary, const py::object& map,
                          const py::kwargs& given) {
    const Problem problem(surface, boundary, map);
    ProvedBoundsOptions options;
    Keywords keywords(given);
    keywords.take("most_faces_for_pairs", options.most_faces_for_pairs);
    keywords.take("exact_polygons", options.exact_polygons);
    take_pairs(keywords, options.pair);
    keywords.finish();
    return without_lock([&] { return proved_bounds(surface->surface, boundary, problem.map, options).bounds; });
}

BracketObject bracket(const SurfacePtr& surface, const BoundaryCondition& boundary, const py::object& map,
                      const py::kwargs& given) {
    const Problem problem(surface, boundary, map);
    require_triangles(surface->surface);
    if (!boundary.lines.empty()) throw Error(Cause::bad_boundary, "vertices are held to lines, which is not verified");
    VerifiedBracketOptions options;
    Keywords keywords(given);
    keywords.take("gap", options.gap);
    keywords.take("K_lower", options.K_lower);
    keywords.take("most_triangles", options.most_triangles);
    keywords.take("most_rounds", options.most_rounds);
    keywords.take("least_progress", options.least_progress);
    take_pairs(keywords, options.pair);
    keywords.finish();
    if (!(options.gap > 0) || !(options.K_lower >= 1) || options.most_rounds < 0)
        throw Error(Cause::bad_option, "gap is to be positive, K_lower from 1, most_rounds from 0");
    return without_lock([&] {
        VerifiedBracket found = verified_bracket(surface->surface, boundary, problem.map, options);
        SurfacePtr refined = make_surface(found.surface.mesh, found.surface.metric);
        return BracketObject{std::move(found), std::move(refined)};
    });
}

/// An extremal map with a bracket.
struct CertificationObject {
    ExtremalPtr result;
    Certification numbers;  // without its map
    CertificateRecord certificate;

    Record record() const {
        Record record = result->record();
        record.certificate = certificate;
        return record;
    }
};

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
        made.certificate = certificate_record(made.numbers, gap);
        made.result = std::make_shared<ExtremalObject>(surface, std::move(made.numbers.result), seconds() - start);
        made.numbers.result = {};
        return made;
    });
}

void bind_certify(py::module_& m) {
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
        .def(
            "to_json", [](const CertificationObject& o) { return to_json(o.record()); },
            "The record as JSON (docs/json.md).")
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

}  // namespace

void bind_bounds(py::module_& m) {
    bind_certify(m);
    m.def(
        "proved_bounds", &proved, py::arg("surface"), py::arg("boundary"), py::arg("map"),
        "Lower bounds of the dilatation of every map with the boundary values, proved up to rounding: a list of Bound, "
        "the best of each kind (corners, moduli, pairs).\n\nboundary: prescribes the whole boundary. map: #V, with "
        "these values, folded or not.\n\nOptions: most_faces_for_pairs=5000, exact_polygons=False, most_steps=40, "
        "pair_tolerance=1e-5.\n\nRaises BadBoundary, BadMesh, BadOption, NotSolved.");
    py::class_<BracketObject>(
        m, "VerifiedBracket",
        "Two numbers between which K* is proved to lie, up to rounding, and the map that shows it.")
        .def_property_readonly("K_lower", [](const BracketObject& o) { return o.bracket.K_lower; })
        .def_property_readonly("K_upper", [](const BracketObject& o) { return o.bracket.K_upper; })
        .def_property_readonly(
            "reached", [](const BracketObject& o) { return o.bracket.reached; },
            "Whether the gap is as small as wanted")
        .def_property_readonly(
            "reason", [](const BracketObject& o) { return o.bracket.reason; }, "Why it ended")
        .def_readonly("surface", &BracketObject::surface, "The Surface, refined where it had to be")
        .def_property_readonly(
            "boundary", [](const BracketObject& o) { return o.bracket.boundary; }, "The BoundaryCondition on it")
        .def_property_readonly(
            "cones", [](const BracketObject& o) { return index_array(o.bracket.cones); },
            "Vertices with power elements")
        .def_property_readonly(
            "map", [](const py::object& self) { return view(self.cast<const BracketObject&>().bracket.map, self); },
            "#V+#E images of the vertices, then of the edges' midpoints: piecewise quadratic")
        .def_property_readonly("refinements", [](const BracketObject& o) { return o.bracket.refinements; })
        .def("__repr__", [](const BracketObject& o) {
            return "<beltrami.VerifiedBracket: K* in [" + std::to_string(o.bracket.K_lower) + ", " +
                   std::to_string(o.bracket.K_upper) + "]>";
        });
    m.def(
        "verified_bracket", &bracket, py::arg("surface"), py::arg("boundary"), py::arg("map"),
        "Proves a bracket of K* for the polyhedral surface and boundary values that are linear along its edges.\n\n"
        "boundary and map: as of proved_bounds; all faces are triangles.\n\nOptions: gap=0.01 (stop at K_upper ≤ (1 + "
        "gap) K_lower), K_lower=1 (proved already), most_triangles=12000, most_rounds=8, least_progress=0.1, "
        "most_steps=40, pair_tolerance=1e-5.\n\nRaises BadBoundary, BadMesh, BadOption, NotSolved.");
    m.def(
        "quadrilateral_bound",
        [](const SurfacePtr& surface, const py::object& map, const std::array<int, 4>& positions) {
            require_disk(surface->surface);
            require_triangles(surface->surface);
            const Eigen::VectorXcd images = map_of(*surface, map);
            const auto size = static_cast<int>(surface->surface.topology.boundary_loops[0].size());
            for (std::size_t i = 0; i < 4; ++i)
                if (positions[i] < 0 || positions[i] >= size || (i > 0 && positions[i] <= positions[i - 1]))
                    throw Error(Cause::bad_option, "positions are not four ascending ones of the boundary loop");
            const std::optional<BoundaryImage> image =
                images.allFinite() ? filled_image(surface->surface, images) : std::nullopt;
            if (!image)
                throw Error(Cause::bad_boundary, "the image of the boundary is no simple counter-clockwise polygon");
            return without_lock([&] { return quadrilateral_bound(surface->surface, *image, positions); });
        },
        py::arg("surface"), py::arg("map"), py::arg("positions"),
        "What one quadrilateral proves: K* is at least the ratio of the moduli of a disk and of its image between "
        "corners at four positions of the boundary loop.\n\nmap: #V of which the boundary counts. positions: 4, "
        "ascending.\n\nRaises BadMesh, BadBoundary, BadOption.");
    m.def(
        "mesh_harmonic_bound",
        [](const SurfacePtr& surface, const py::object& harmonic) {
            return mesh_harmonic_bound(surface->surface.operators, map_of(*surface, harmonic, "harmonic"));
        },
        py::arg("surface"), py::arg("harmonic"),
        "Every piecewise linear map of this mesh with the boundary values of a harmonic map (#V) has at least this K: "
        "c + √(c²−1), c its Dirichlet energy over the area of the image; 1 where that is not positive.");
}

}  // namespace beltrami::python
