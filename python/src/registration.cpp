#include <beltrami/registration/register_curves.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/register_spheres.h>

#include "extremal_map.h"
#include "module.h"
#include "registration.h"

namespace beltrami::python {

namespace {

/// Vertices of a mesh, or Places on it.
std::vector<MeshPoint> places_from(const Mesh& mesh, const py::object& places, const char* name) {
    if (py::isinstance<Places>(places)) {
        require_on(mesh, places.cast<const Places&>());
        return places.cast<const Places&>().points;
    }
    std::vector<MeshPoint> points;
    for (const int v : vertex_list(places, name, mesh.vertex_count())) points.push_back(place_of_vertex(mesh, v));
    return points;
}

/// Vertices and the vertices of the target, or Places on it, to which they go.
std::vector<SurfaceLandmark> landmarks_from(const SurfacePtr& target, const py::object& vertices,
                                            const py::object& places, const py::object& weights) {
    const std::vector<int> list = whole_numbers(vertices, "vertices");
    const std::vector<MeshPoint> at = places_from(target->surface.mesh, places, "places");
    Eigen::VectorXd weight;
    if (!weights.is_none()) weight = real_numbers(weights, "weights");
    if (at.size() != list.size() || (!weights.is_none() && weight.size() != static_cast<Eigen::Index>(list.size())))
        throw Error(Cause::bad_option, "vertices, places and weights of the landmarks are not equally many");
    std::vector<SurfaceLandmark> landmarks;
    for (std::size_t i = 0; i < list.size(); ++i) {
        SurfaceLandmark landmark;
        landmark.vertex = list[i];
        landmark.place = at[i];
        if (weight.size() > 0) landmark.weight = weight[static_cast<Eigen::Index>(i)];
        landmarks.push_back(landmark);
    }
    return landmarks;
}

std::vector<MeshPoint> start_from(Keywords& keywords, const SurfacePtr& source, const SurfacePtr& target) {
    const py::object start = keywords.taken("start");
    if (!start || start.is_none()) return {};
    std::vector<MeshPoint> places = places_from(target->surface.mesh, start, "start");
    if (static_cast<int>(places.size()) != source->vertex_count())
        throw Error(Cause::bad_option, "start is not one place for each vertex of the source");
    return places;
}

std::vector<SurfaceWaypoint> waypoints_from(Keywords& keywords, const SurfacePtr& target) {
    std::vector<SurfaceWaypoint> result;
    const py::object waypoints = keywords.taken("waypoints");
    if (!waypoints || waypoints.is_none()) return result;
    for (const py::handle item : waypoints) {
        if (!py::isinstance<py::sequence>(item) || py::len(item) != 3)
            throw py::type_error("waypoints are (step, vertex, vertex of the target)");
        const auto tuple = value_of<std::array<int, 3>>(item, "waypoints are (step, vertex, vertex of the target)");
        if (tuple[2] < 0 || tuple[2] >= target->vertex_count())
            throw Error(Cause::bad_option, "the target has no vertex " + std::to_string(tuple[2]));
        result.push_back({tuple[0], tuple[1], place_of_vertex(target->surface.mesh, tuple[2])});
    }
    return result;
}

RegistrationPtr spheres(const SurfacePtr& source, const SurfacePtr& target, const py::object& vertices,
                        const py::object& places, const py::object& weights, const py::kwargs& given) {
    const std::vector<SurfaceLandmark> landmarks = landmarks_from(target, vertices, places, weights);
    Interruption interruption;
    RegistrationOptions options;
    Keywords keywords(given);
    keywords.iteration(interruption, options.map);
    keywords.take("check_inverse", options.check_inverse);
    options.start = start_from(keywords, source, target);
    options.waypoints = waypoints_from(keywords, target);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        SphereRegistration found = register_spheres(source->surface, target->surface, landmarks, options);
        Record record = space_record(source, "register", map_record(found.map), found.warnings);
        record.solve = solve_record(found.map, seconds() - begun);
        record.registration = registration_record(found, "", landmarks.size());
        auto object = std::make_shared<RegistrationObject>(source, found, found.map.distortion, std::move(record));
        object->phi = found.map.phi;
        object->correspondence = std::make_shared<SurfaceCorrespondence>(source->surface.mesh, target->surface.mesh,
                                                                         found.target_sphere.positions, found.places);
        return object;
    });
}

RegistrationPtr open(const SurfacePtr& source, const SurfacePtr& target, const py::object& vertices,
                     const py::object& places, const py::object& weights, int outer_loop, int target_outer_loop,
                     const py::kwargs& given) {
    require_loop(*source, outer_loop);
    require_loop(*target, target_outer_loop);
    const std::vector<SurfaceLandmark> landmarks = landmarks_from(target, vertices, places, weights);
    Interruption interruption;
    OpenRegistrationOptions options;
    options.outer_loop = outer_loop;
    options.target_outer_loop = target_outer_loop;
    Keywords keywords(given);
    keywords.take("check_inverse", options.check_inverse);
    options.waypoints = waypoints_from(keywords, target);
    take_extremal(keywords, interruption, {source.get(), target.get()}, options.map);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        OpenRegistration found = register_open(source->surface, target->surface, landmarks, options);
        Record record = space_record(source, "register", map_record(found.map), found.warnings);
        record.solve = solve_record(found.map, seconds() - begun);
        record.registration = registration_record(found, "", landmarks.size());
        const Surface& surface = source->surface;
        const Distortion own =
            found.map.split  // of the surface's own faces
                ? distortion(surface.operators, Eigen::VectorXcd(found.map.map.head(surface.mesh.vertex_count())))
                : found.map.distortion;
        auto object = std::make_shared<RegistrationObject>(source, found, own, std::move(record));
        object->phi = found.map.phi;
        if (found.map.one_to_one())
            object->correspondence =
                std::make_shared<SurfaceCorrespondence>(source->surface, target->surface, found.target, found.places);
        return object;
    });
}

/// (points of the source, points of the target, closed, slides), the last two as one likes.
std::vector<CurvePair> curves_from(const SurfacePtr& source, const SurfacePtr& target, const py::object& object) {
    std::vector<CurvePair> curves;
    if (object.is_none()) return curves;
    if (!py::isinstance<py::sequence>(object)) throw py::type_error("curves are a list");
    for (const py::handle item : object) {
        if (!py::isinstance<py::sequence>(item) || py::len(item) < 2 || py::len(item) > 4)
            throw py::type_error("a curve is (vertices or Places of the source, of the target, closed, slides)");
        const py::sequence tuple = py::reinterpret_borrow<py::sequence>(item);
        CurvePair pair;
        pair.source.points = places_from(source->surface.mesh, tuple[0], "a curve of the source");
        pair.target.points = places_from(target->surface.mesh, tuple[1], "a curve of the target");
        if (py::len(item) > 2)
            pair.source.closed = pair.target.closed = value_of<bool>(tuple[2], "closed is True or False");
        if (py::len(item) > 3) pair.slides = value_of<bool>(tuple[3], "slides is True or False");
        curves.push_back(std::move(pair));
    }
    return curves;
}

RegistrationPtr least_lp(const SurfacePtr& source, const SurfacePtr& target, const py::object& vertices,
                         const py::object& places, const py::object& curves, double p, const py::kwargs& given) {
    const std::vector<SurfaceLandmark> landmarks = landmarks_from(target, vertices, places, py::none());
    const std::vector<CurvePair> pairs = curves_from(source, target, curves);
    Interruption interruption;
    CurveRegistrationOptions options;
    options.p = p;
    Keywords keywords(given);
    keywords.take("extremal", options.extremal);
    keywords.take("outer_loop", options.outer_loop);
    keywords.take("target_outer_loop", options.target_outer_loop);
    if (!source->surface.topology.boundary_loops.empty()) {
        require_loop(*source, options.outer_loop);
        if (!target->surface.topology.boundary_loops.empty()) require_loop(*target, options.target_outer_loop);
    }
    keywords.take("tolerance", options.flow.tolerance);
    keywords.take("max_iterations", options.flow.max_iterations);
    options.start = start_from(keywords, source, target);
    std::function<bool(int, double)> progress;
    keywords.progress(interruption, progress);
    keywords.finish();
    if (progress)
        options.flow.progress = [&](int iteration, const SurfaceFlowIteration& now, const TargetMap&) {
            return progress(iteration, now.error.l2);
        };
    const double begun = seconds();
    return without_lock(interruption, [&] {
        LpRegistration found = register_least_lp(source->surface, target->surface, landmarks, pairs, options);
        Record record = space_record(source, "register", map_record(found), found.warnings);
        record.solve = solve_record(found.map, seconds() - begun);
        record.registration = registration_record(found, p, "", landmarks.size());
        auto object = std::make_shared<RegistrationObject>(source, found, found.carried.distortion, std::move(record));
        if (source->surface.topology.boundary_loops.empty())
            object->correspondence = std::make_shared<SurfaceCorrespondence>(source->surface.mesh, target->surface.mesh,
                                                                             found.image, found.places);
        return object;
    });
}

const SurfaceCorrespondence& correspondence_of(const RegistrationObject& object) {
    if (!object.correspondence)
        throw Error(Cause::bad_option, "faces of the map are flipped, so that it carries nothing",
                    "see its warnings and flipped faces");
    return *object.correspondence;
}

constexpr const char* kLandmarks = "vertices: n of the source. places: n vertices of the target, or Places on it.";

}  // namespace

void bind_registration(py::module_& m) {
    py::class_<RegistrationObject, CarriedObject, RegistrationPtr>(m, "Registration",
                                                                   "A surface of genus 0 carried onto another one.")
        .def_property_readonly(
            "k", [](const RegistrationObject& o) { return o.record().map->k; },
            "An estimate of k*; None of least Lᵖ maps")
        .def_property_readonly(
            "K", [](const RegistrationObject& o) { return o.record().map->K; },
            "An estimate of K*; None of least Lᵖ maps")
        .def_property_readonly(
            "K_lower", [](const RegistrationObject& o) { return o.record().map->K_lower; },
            "An estimate of a lower bound of K*; None of least Lᵖ maps")
        .def_property_readonly(
            "phi", [](const py::object& self) { return view(self.cast<const RegistrationObject&>().phi, self); },
            "#S values of the quadratic differential; empty of least Lᵖ maps")
        .def_property_readonly(
            "inverse_k", [](const RegistrationObject& o) { return o.record().registration->inverse_k; },
            "k of the inverse map from the target's own mesh: how far k is from it estimates the meshes' error")
        .def_property_readonly(
            "correspondence", [](const RegistrationObject& o) { return o.correspondence; },
            "The SurfaceCorrespondence, for places both ways and transfers; None where faces are flipped, and of least "
            "Lᵖ "
            "maps of open surfaces")
        .def(
            "transfer",
            [](const RegistrationObject& o, const py::object& values, bool to_source) {
                return transferred_values(correspondence_of(o), values, to_source, false);
            },
            py::arg("values"), py::arg("to_source") = false,
            "Values of the vertices of one surface (#V or #V×m) at those of the other: #V×m.\n\nRaises BadOption "
            "where faces are flipped, or unless there are #V.")
        .def(
            "transfer_faces",
            [](const RegistrationObject& o, const py::object& values, bool to_source) {
                return transferred_values(correspondence_of(o), values, to_source, true);
            },
            py::arg("values"), py::arg("to_source") = false,
            "Values of the faces (#F or #F×m), as means over the other's faces: #F×m.\n\nRaises BadOption.")
        .def(
            "forward",
            [](const RegistrationObject& o, const Places& places) {
                return carried_places(correspondence_of(o), places, false);
            },
            py::arg("places"), "Places of the source on the target.\n\nRaises BadOption where faces are flipped.")
        .def(
            "back",
            [](const RegistrationObject& o, const Places& places) {
                return carried_places(correspondence_of(o), places, true);
            },
            py::arg("places"), "Places of the target on the source.\n\nRaises BadOption where faces are flipped.");
    m.def(
        "register_spheres", &spheres, py::arg("source"), py::arg("target"), py::arg("vertices") = py::list(),
        py::arg("places") = py::list(), py::arg("weights") = py::none(),
        (std::string(
             "The extremal map between two closed surfaces of genus 0 that takes landmarks to their places.\n\n") +
         kLandmarks +
         " weights: n, finite ones make landmarks soft.\n\nOptions: tolerance, max_iterations=40, check_inverse=True, "
         "start=None (#V vertices or Places), waypoints=[(step, vertex, vertex of the target), …], which choose the "
         "homotopy class, progress=None.\n\nRaises BadMesh, BadBoundary, BadOption, NotSolved, Cancelled.")
            .c_str());
    m.def("register_open", &open, py::arg("source"), py::arg("target"), py::arg("vertices") = py::list(),
          py::arg("places") = py::list(), py::arg("weights") = py::none(), py::arg("outer_loop") = 0,
          py::arg("target_outer_loop") = 0,
          (std::string(
               "The extremal map between two surfaces of genus 0 with equally many boundary loops that takes landmarks "
               "to their places; boundaries slide along each other.\n\nvertices, places and weights as of "
               "register_spheres. check_inverse=True finds inverse_k. waypoints=[(step, vertex, vertex of the "
               "target)]: ways "
               "of landmarks inside, which choose the homotopy class.\n\n") +
           kExtremalOptions)
              .c_str());
    m.def("register_least_lp", &least_lp, py::arg("source"), py::arg("target"), py::arg("vertices") = py::list(),
          py::arg("places") = py::list(), py::arg("curves") = py::none(), py::arg("p") = 2.0,
          (std::string(
               "The map between two surfaces of genus 0, both closed or with equally many boundary loops, of least "
               "Lᵖ norm of |μ|, that takes curves to curves and landmarks to their places.\n\n") +
           kLandmarks +
           " curves: (points of the source, points of the target, closed=False, slides=True) each, points being "
           "vertices or Places that geodesics join. p: from 2; the larger the more even |μ| is.\n\nOptions: "
           "outer_loop=0, target_outer_loop=0, tolerance=1e-8, max_iterations=100, start=None (#V vertices or Places), "
           "extremal=False (go on from there to the map of least dilatation, with an estimate of k), "
           "progress=None.\n\nRaises BadMesh, BadBoundary, BadOption, NotSolved, Cancelled. Source: Wong & Zhao 2014.")
              .c_str());
}

}  // namespace beltrami::python
