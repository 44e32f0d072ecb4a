#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/uniformize/sphere_map.h>

#include "extremal_map.h"
#include "module.h"
#include "space_map.h"

namespace beltrami::python {

namespace {

SphereMethod method_from(const std::string& word) {
    return Keywords::choice<SphereMethod>("method", py::str(word),
                                          {{"conformal_equivalence", SphereMethod::conformal_equivalence},
                                           {"least_distortion", SphereMethod::least_distortion},
                                           {"tutte", SphereMethod::tutte}});
}

/// A conformal map of a closed surface to the sphere.
class SphereObject final : public SpaceMap {
  public:
    SphereObject(const SurfacePtr& source, SphereMap found, Record record)
        : SpaceMap(source, "sphere", found.positions, found.distortion, std::move(record)), found_(std::move(found)) {}
    const SphereMap& found() const { return found_; }

  private:
    SphereMap found_;
};
using SpherePtr = std::shared_ptr<SphereObject>;

/// An extremal map to the sphere.
class ExtremalSphereObject final : public SpaceMap {
  public:
    ExtremalSphereObject(const SurfacePtr& source, ExtremalSphereMap found, Record record)
        : SpaceMap(source, "extremal", found.positions, found.distortion, std::move(record)),
          found_(std::move(found)) {}
    const ExtremalSphereMap& found() const { return found_; }

  private:
    ExtremalSphereMap found_;
};
using ExtremalSpherePtr = std::shared_ptr<ExtremalSphereObject>;

SpherePtr sphere(const SurfacePtr& surface, const SphereMapOptions& options) {
    if (options.ideal_vertex && (*options.ideal_vertex < 0 || *options.ideal_vertex >= surface->vertex_count()))
        throw Error(Cause::bad_option, "there is no vertex " + std::to_string(*options.ideal_vertex));
    const double begun = seconds();
    return without_lock([&] {
        SphereMap found = sphere_map(surface->surface, options);
        Record record = space_record(surface, "uniformize", map_record(found.distortion), found.warnings);
        record.solve = solve_of(found.iterations, found.factorizations, Termination::converged, seconds() - begun);
        record.sphere = sphere_record(found);
        return std::make_shared<SphereObject>(surface, std::move(found), std::move(record));
    });
}

Positions on_sphere(const SurfacePtr& surface, const py::object& object, const char* name) {
    if (py::isinstance<SpaceMap>(object)) {
        const auto& map = object.cast<const SpaceMap&>();
        if (map.positions().rows() == surface->vertex_count() && map.positions().cols() == 3) return map.positions();
    }
    return points_of(object, name, surface->vertex_count(), 3);
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

/// #L×3 stops of landmarks; rows of NaN are allowed.
Positions stops_from(const py::object& object, std::size_t landmarks) {
    const Positions stops = table(object, "waypoints", static_cast<int>(landmarks));
    if (stops.cols() != 3) throw Error(Cause::bad_option, "waypoints are not n×3");
    return stops;
}

ExtremalSpherePtr extremal_sphere(const SurfacePtr& surface, const py::object& conformal, const py::object& vertices,
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
    if (const py::object waypoints = keywords.taken("waypoints"); waypoints && !waypoints.is_none())
        for (const py::handle stop : waypoints)
            options.waypoints.push_back(stops_from(py::reinterpret_borrow<py::object>(stop), landmarks.size()));
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        ExtremalSphereMap found = extremal_sphere_map(surface->surface, sphere, landmarks, options);
        Record record = space_record(surface, "register", map_record(found), found.warnings);
        record.solve = solve_record(found, seconds() - begun);
        return std::make_shared<ExtremalSphereObject>(surface, std::move(found), std::move(record));
    });
}

}  // namespace

void bind_sphere(py::module_& m) {
    const auto field = [](auto member) { return [member](const SphereObject& o) { return o.found().*member; }; };
    py::class_<SphereObject, SpaceMap, SpherePtr>(
        m, "SphereMap", "A map of a closed surface of genus 0 to the unit sphere, no face flipped; positions are #V×3.")
        .def_property_readonly(
            "log_scale",
            [](const py::object& self) { return view(self.cast<const SphereObject&>().found().log_scale, self); },
            "#V, of conformal equivalence: log of the scale factor; else empty")
        .def_property_readonly("method", [](const SphereObject& o) { return std::string(to_string(o.found().method)); })
        .def_property_readonly(
            "route", [](const SphereObject& o) { return std::string(to_string(o.found().route)); },
            "What had to be done until no face was flipped: \"direct\", \"averaged\", \"unfolded\" or \"fallback\"")
        .def_property_readonly("moved", field(&SphereMap::moved), "Vertices that were moved to turn flipped faces up")
        .def_property_readonly("residual", field(&SphereMap::residual), "Largest angle defect left, radians")
        .def_property_readonly("centre_distance", field(&SphereMap::centre_distance),
                               "Of the centre of mass from the sphere's centre")
        .def_property_readonly(
            "unresolved", [](const SphereObject& o) { return index_array(o.found().unresolved); },
            "Faces that doubles cannot place");
    m.def(
        "sphere_map",
        [](const SurfacePtr& surface, const std::string& method, double tolerance, int max_iterations,
           const std::optional<int>& ideal_vertex, bool fall_back) {
            return sphere(surface, {method_from(method), tolerance, max_iterations, ideal_vertex, fall_back});
        },
        py::arg("surface"), py::arg("method") = "conformal_equivalence", py::kw_only(), py::arg("tolerance") = 1e-10,
        py::arg("max_iterations") = 200, py::arg("ideal_vertex") = py::none(), py::arg("fall_back") = true,
        "The conformal map of a closed surface of genus 0 to the round sphere, its centre of mass at the sphere's "
        "centre.\n\nmethod: \"conformal_equivalence\", \"least_distortion\" or \"tutte\". tolerance: largest angle "
        "defect, radians. ideal_vertex: sent to infinity on the way (None: chosen). fall_back: whether "
        "least_distortion may take the place of a method that fails.\n\nRaises BadMesh, BadOption, NotSolved naming "
        "faces. Source: Springborn 2020; Gillespie, Springborn, Crane 2021.");
    m.def(
        "require_sphere", [](const SurfacePtr& surface) { require_sphere(surface->surface); }, py::arg("surface"),
        "Raises BadMesh unless the surface is one component, closed and of genus 0.");

    const auto extremal = [](auto member) {
        return [member](const ExtremalSphereObject& o) { return o.found().*member; };
    };
    py::class_<ExtremalSphereObject, SpaceMap, ExtremalSpherePtr>(
        m, "ExtremalSphereMap", "An extremal map to the unit sphere (positions, #V×3), and how good it is.")
        .def_property_readonly(
            "phi",
            [](const py::object& self) { return view(self.cast<const ExtremalSphereObject&>().found().phi, self); },
            "#S values of the quadratic differential, in the samples' frames")
        .def_property_readonly("k", extremal(&ExtremalSphereMap::k), "An estimate of k*")
        .def_property_readonly("K", extremal(&ExtremalSphereMap::K), "An estimate of K* = (1+k*)/(1−k*)")
        .def_property_readonly("K_lower", extremal(&ExtremalSphereMap::K_lower), "An estimate of a lower bound of K*")
        .def_property_readonly("bounds", extremal(&ExtremalSphereMap::bounds))
        .def_property_readonly("dimension", extremal(&ExtremalSphereMap::dimension), "Of the differentials, complex")
        .def_property_readonly("residual", extremal(&ExtremalSphereMap::residual),
                               "Largest distance of a soft landmark from its image")
        .def_property_readonly("separation", extremal(&ExtremalSphereMap::separation),
                               "Least distance between two landmarks, before or after")
        .def_property_readonly("history", extremal(&ExtremalSphereMap::history));
    m.def(
        "extremal_sphere_map", &extremal_sphere, py::arg("surface"), py::arg("on_sphere"), py::arg("vertices"),
        py::arg("images"), py::arg("weights") = py::none(),
        "The extremal map of a closed surface of genus 0 to the unit sphere that takes landmarks to their images.\n\n"
        "on_sphere: a SphereMap, or #V×3 conformal map. vertices: n. images: n×3 unit vectors. weights: n, "
        "finite ones make landmarks soft (None: all are met).\n\nOptions: tolerance, max_iterations=40, "
        "cluster_count=1500, start=None (#V×3), waypoints=[n×3, …] (stops of the landmarks on the sphere, which choose "
        "the class; NaN: none), progress=None.\n\nRaises BadMesh, BadOption, BadBoundary, NotSolved, "
        "Cancelled.");
}

}  // namespace beltrami::python
