#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/uniformize/sphere_map.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

SphereMethod method_from(const std::string& word) {
    return Keywords::choice<SphereMethod>("method", py::str(word),
                                          {{"conformal_equivalence", SphereMethod::conformal_equivalence},
                                           {"least_distortion", SphereMethod::least_distortion},
                                           {"tutte", SphereMethod::tutte}});
}

Positions on_sphere(const SurfacePtr& surface, const py::object& object, const char* name) {
    Positions result = points(object, name);
    if (result.rows() != surface->vertex_count() || result.cols() != 3)
        throw Error(Cause::bad_option, std::string(name) + " is not one point of space for each vertex");
    return result;
}

std::vector<SphereLandmark> landmarks_from(const py::object& vertices, const py::object& images,
                                           const py::object& weights) {
    const std::vector<int> list = whole_numbers(vertices, "vertices");
    const Positions at = table(images, "images", static_cast<int>(list.size()));
    if (!list.empty() && at.cols() != 3) throw Error(Cause::bad_option, "images are not n×3");
    Eigen::VectorXd weight;
    if (!weights.is_none()) {
        weight = real_numbers(weights, "weights");
        if (weight.size() != static_cast<Eigen::Index>(list.size()))
            throw Error(Cause::bad_option, "there is not one weight for each landmark");
    }
    std::vector<SphereLandmark> landmarks;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        SphereLandmark landmark;
        landmark.vertex = list[i];
        landmark.image = at.row(row);
        if (weight.size() > 0) landmark.weight = weight[row];
        landmarks.push_back(landmark);
    }
    return landmarks;
}

ExtremalSphereMap extremal_sphere(const SurfacePtr& surface, const py::object& conformal, const py::object& vertices,
                                  const py::object& images, const py::object& weights, const py::kwargs& given) {
    const Positions sphere = on_sphere(surface, conformal, "on_sphere");
    const std::vector<SphereLandmark> landmarks = landmarks_from(vertices, images, weights);
    Interruption interruption;
    ExtremalSphereOptions options;
    Keywords keywords(given);
    keywords.iteration(interruption, options);
    keywords.take("cluster_count", options.cluster_count);
    if (const py::object start = keywords.taken("start"); start && !start.is_none())
        options.start = on_sphere(surface, start, "start");
    keywords.finish();
    return without_lock(interruption,
                        [&] { return extremal_sphere_map(surface->surface, sphere, landmarks, options); });
}

}  // namespace

void bind_sphere(py::module_& m) {
    py::class_<SphereMap>(m, "SphereMap", "A map of a closed surface of genus 0 to the unit sphere, no face flipped.")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const SphereMap&>().positions, self); },
            "#V×3 unit vectors")
        .def_property_readonly(
            "log_scale", [](const py::object& self) { return view(self.cast<const SphereMap&>().log_scale, self); },
            "#V, of conformal equivalence; else empty")
        .def_readonly("distortion", &SphereMap::distortion)
        .def_property_readonly("method", [](const SphereMap& map) { return std::string(to_string(map.method)); })
        .def_property_readonly("route", [](const SphereMap& map) { return std::string(to_string(map.route)); })
        .def_readonly("moved", &SphereMap::moved)
        .def_readonly("residual", &SphereMap::residual, "Largest angle defect left, radians")
        .def_readonly("centre_distance", &SphereMap::centre_distance)
        .def_property_readonly(
            "unresolved", [](const SphereMap& map) { return index_array(map.unresolved); },
            "Faces that doubles cannot place")
        .def_property_readonly("warnings", [](const SphereMap& map) { return map.warnings; })
        .def("__repr__", [](const SphereMap& map) {
            return "<beltrami.SphereMap: K_max " + std::to_string(map.distortion.K_max()) + ", " +
                   to_string(map.method) + ">";
        });
    m.def(
        "sphere_map",
        [](const SurfacePtr& surface, const std::string& method, double tolerance, int max_iterations,
           const std::optional<int>& ideal_vertex, bool fall_back) {
            SphereMapOptions options{method_from(method), tolerance, max_iterations, ideal_vertex, fall_back};
            if (ideal_vertex && (*ideal_vertex < 0 || *ideal_vertex >= surface->vertex_count()))
                throw Error(Cause::bad_option, "there is no vertex " + std::to_string(*ideal_vertex));
            return without_lock([&] { return sphere_map(surface->surface, options); });
        },
        py::arg("surface"), py::arg("method") = "conformal_equivalence", py::kw_only(), py::arg("tolerance") = 1e-10,
        py::arg("max_iterations") = 200, py::arg("ideal_vertex") = py::none(), py::arg("fall_back") = true,
        "The conformal map of a closed surface of genus 0 to the round sphere, its centre of mass at the sphere's "
        "centre.\n\nmethod: \"conformal_equivalence\", \"least_distortion\" or \"tutte\".\n\nRaises BadMesh, "
        "BadOption, "
        "NotSolved naming faces. Source: Springborn 2020; Gillespie, Springborn, Crane 2021.");

    py::class_<ExtremalSphereMap>(m, "ExtremalSphereMap", "An extremal map to the unit sphere, and how good it is.")
        .def_property_readonly(
            "positions",
            [](const py::object& self) { return view(self.cast<const ExtremalSphereMap&>().positions, self); },
            "#V×3 unit vectors")
        .def_property_readonly(
            "phi", [](const py::object& self) { return view(self.cast<const ExtremalSphereMap&>().phi, self); }, "#S")
        .def_property_readonly("distortion", [](const ExtremalSphereMap& map) { return map.distortion; })
        .def_readonly("k", &ExtremalSphereMap::k)
        .def_readonly("K", &ExtremalSphereMap::K)
        .def_readonly("K_lower", &ExtremalSphereMap::K_lower, "An estimate")
        .def_readonly("K_max", &ExtremalSphereMap::K_max)
        .def_readonly("residual", &ExtremalSphereMap::residual, "Largest distance of a soft landmark from its image")
        .def_property_readonly("iterations", [](const ExtremalSphereMap& map) { return map.iterations; })
        .def_property_readonly("termination",
                               [](const ExtremalSphereMap& map) { return std::string(to_string(map.termination)); })
        .def_property_readonly("warnings", [](const ExtremalSphereMap& map) { return map.warnings; })
        .def("__repr__", [](const ExtremalSphereMap& map) {
            return "<beltrami.ExtremalSphereMap: K " + std::to_string(map.K) + ", " + to_string(map.termination) + ">";
        });
    m.def("extremal_sphere_map", &extremal_sphere, py::arg("surface"), py::arg("on_sphere"), py::arg("vertices"),
          py::arg("images"), py::arg("weights") = py::none(),
          "The extremal map of a closed surface of genus 0 to the unit sphere that takes landmarks to their images.\n\n"
          "on_sphere: #V×3 conformal map (sphere_map(…).positions). vertices: n. images: n×3 unit vectors. weights: n, "
          "finite ones make landmarks soft (None: all are met).\n\nOptions: tolerance, max_iterations=40, "
          "cluster_count=1500, start=None (#V×3), progress=None.\n\nRaises BadMesh, BadOption, BadBoundary, NotSolved, "
          "Cancelled.");
}

}  // namespace beltrami::python
