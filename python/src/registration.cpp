#include <beltrami/registration/register_open.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/registration/transfer.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// Vertices and the vertices of the target, or Places on it, to which they go.
std::vector<SurfaceLandmark> landmarks_from(const SurfacePtr& target, const py::object& vertices,
                                            const py::object& places, const py::object& weights) {
    const std::vector<int> list = whole_numbers(vertices, "vertices");
    std::vector<MeshPoint> at;
    const Mesh& mesh = target->surface.mesh;
    if (py::isinstance<Places>(places)) {
        require_on(mesh, places.cast<const Places&>());
        at = places.cast<const Places&>().points;
    } else {
        for (const int v : whole_numbers(places, "places")) {
            if (v < 0 || v >= mesh.vertex_count())
                throw Error(Cause::bad_option, "the target has no vertex " + std::to_string(v));
            at.push_back(place_of_vertex(mesh, v));
        }
    }
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

struct RegistrationObject {
    Places places;
    Positions positions;
    Distortion in_space;
    std::vector<int> unresolved;
    std::optional<double> largest_distance;
    double k = 0, K = 1, K_lower = 1, K_max = 1;
    std::string termination;
    Warnings warnings;
    std::optional<double> inverse_k;
    std::shared_ptr<SurfaceCorrespondence> correspondence;  // null where faces are flipped

    template <class Map>
    void take_map(const Map& map, Warnings&& found) {
        k = map.k;
        K = map.K;
        K_lower = map.K_lower;
        K_max = map.K_max;
        termination = to_string(map.termination);
        warnings = std::move(found);
    }
    void take(CarriedSurface&& carried) {
        places.points = std::move(carried.places);
        positions = std::move(carried.positions);
        in_space = std::move(carried.in_space);
        unresolved = std::move(carried.unresolved);
        largest_distance = carried.largest_distance;
    }
};

RegistrationObject spheres(const SurfacePtr& source, const SurfacePtr& target, const py::object& vertices,
                           const py::object& places, const py::object& weights, const py::kwargs& given) {
    const std::vector<SurfaceLandmark> landmarks = landmarks_from(target, vertices, places, weights);
    Interruption interruption;
    RegistrationOptions options;
    Keywords keywords(given);
    keywords.iteration(interruption, options.map);
    keywords.take("check_inverse", options.check_inverse);
    keywords.finish();
    return without_lock(interruption, [&] {
        SphereRegistration found = register_spheres(source->surface, target->surface, landmarks, options);
        RegistrationObject object;
        object.take_map(found.map, std::move(found.warnings));
        object.inverse_k = found.inverse_k;
        object.correspondence = std::make_shared<SurfaceCorrespondence>(source->surface.mesh, target->surface.mesh,
                                                                        found.target_sphere.positions, found.places);
        object.take(std::move(found));
        return object;
    });
}

RegistrationObject open(const SurfacePtr& source, const SurfacePtr& target, const py::object& vertices,
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
    take_extremal(keywords, interruption, {source.get(), target.get()}, options.map);
    keywords.finish();
    return without_lock(interruption, [&] {
        OpenRegistration found = register_open(source->surface, target->surface, landmarks, options);
        RegistrationObject object;
        object.take_map(found.map, std::move(found.warnings));
        object.inverse_k = found.inverse_k;
        if (found.map.one_to_one())
            object.correspondence =
                std::make_shared<SurfaceCorrespondence>(source->surface, target->surface, found.target, found.places);
        object.take(std::move(found));
        return object;
    });
}

const SurfaceCorrespondence& correspondence_of(const RegistrationObject& object) {
    if (!object.correspondence)
        throw Error(Cause::bad_option, "faces of the map are flipped, so that it carries nothing",
                    "see its warnings and flipped faces");
    return *object.correspondence;
}

TransferWay way_from(bool to_source) {
    return to_source ? TransferWay::to_source : TransferWay::to_target;
}

}  // namespace

void bind_registration(py::module_& m) {
    py::class_<RegistrationObject>(m, "Registration", "A surface carried onto another one.")
        .def_readonly("places", &RegistrationObject::places, "#V Places of the source's vertices on the target")
        .def_property_readonly(
            "positions",
            [](const py::object& self) { return view(self.cast<const RegistrationObject&>().positions, self); },
            "#V×3 (or ×2, as the target has them) their positions")
        .def_readonly("in_space", &RegistrationObject::in_space, "Distortion of the straight faces between these")
        .def_property_readonly(
            "unresolved", [](const RegistrationObject& o) { return index_array(o.unresolved); },
            "Faces on which the mesh does not resolve the map")
        .def_readonly("largest_distance", &RegistrationObject::largest_distance, "Of soft landmarks from their places")
        .def_readonly("k", &RegistrationObject::k)
        .def_readonly("K", &RegistrationObject::K)
        .def_readonly("K_lower", &RegistrationObject::K_lower)
        .def_readonly("K_max", &RegistrationObject::K_max)
        .def_readonly("inverse_k", &RegistrationObject::inverse_k, "k of the inverse map, a check; None if not known")
        .def_readonly("termination", &RegistrationObject::termination)
        .def_property_readonly("warnings", [](const RegistrationObject& o) { return o.warnings; })
        .def(
            "transfer",
            [](const RegistrationObject& o, const py::object& values, bool to_source) {
                const SurfaceCorrespondence& map = correspondence_of(o);
                const Mesh& from = to_source ? map.target() : map.source();
                const Positions rows = table(values, "values", from.vertex_count());
                return without_lock([&] { return transferred_vertex_values(map, rows, way_from(to_source)); });
            },
            py::arg("values"), py::arg("to_source") = false,
            "Values of the vertices of one surface (#V or #V×m) at those of the other: #V×m.")
        .def(
            "transfer_faces",
            [](const RegistrationObject& o, const py::object& values, bool to_source) {
                const SurfaceCorrespondence& map = correspondence_of(o);
                const Mesh& from = to_source ? map.target() : map.source();
                const Positions rows = table(values, "values", from.face_count());
                return without_lock([&] { return transferred_face_values(map, rows, way_from(to_source)); });
            },
            py::arg("values"), py::arg("to_source") = false, "Values of the faces, as means over the other's faces.")
        .def(
            "forward",
            [](const RegistrationObject& o, const Places& places) {
                const SurfaceCorrespondence& map = correspondence_of(o);
                require_on(map.source(), places);
                return without_lock([&] { return Places{map.forward(places.points)}; });
            },
            py::arg("places"), "Places of the source on the target.")
        .def(
            "back",
            [](const RegistrationObject& o, const Places& places) {
                const SurfaceCorrespondence& map = correspondence_of(o);
                require_on(map.target(), places);
                return without_lock([&] { return Places{map.back(places.points)}; });
            },
            py::arg("places"), "Places of the target on the source.")
        .def("__repr__", [](const RegistrationObject& o) {
            return "<beltrami.Registration: K " + std::to_string(o.K) + ", " + o.termination + ">";
        });
    m.def("register_spheres", &spheres, py::arg("source"), py::arg("target"), py::arg("vertices"), py::arg("places"),
          py::arg("weights") = py::none(),
          "The extremal map between two closed surfaces of genus 0 that takes landmarks to their places.\n\nvertices: "
          "n of the "
          "source. places: n vertices of the target, or Places on it. weights: n, finite ones make landmarks soft.\n\n"
          "Options: tolerance, max_iterations=40, check_inverse=True, progress=None.\n\nRaises BadMesh, BadBoundary, "
          "BadOption, NotSolved, Cancelled.");
    m.def("register_open", &open, py::arg("source"), py::arg("target"), py::arg("vertices"), py::arg("places"),
          py::arg("weights") = py::none(), py::arg("outer_loop") = 0, py::arg("target_outer_loop") = 0,
          (std::string(
               "The extremal map between two surfaces of genus 0 with equally many boundary loops that takes landmarks "
               "to their places; boundaries slide along each other.\n\nvertices, places and weights as of "
               "register_spheres. check_inverse=True finds inverse_k.\n\n") +
           kExtremalOptions)
              .c_str());
}

}  // namespace beltrami::python
