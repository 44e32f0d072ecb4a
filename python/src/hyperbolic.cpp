#include <beltrami/hyperbolic/hyperbolic_places.h>
#include <beltrami/registration/register_handles.h>

#include "extremal_map.h"
#include "hyperbolic.h"
#include "marking.h"
#include "module.h"
#include "space_map.h"

namespace beltrami::python {

const char* const kMarking =
    "The class: of maps that take vertices to the nearest points, after alignment=\"none\" | \"rigid\" | "
    "\"similarity\", or from start=None (#V×3 points near the target); or by paths=[…] and images=[…], as many closed "
    "paths of vertices through one vertex as the surface has generators, on the source and the target; then "
    "twists=[(path, turns), …] about simple closed paths of the source.";

Alignment alignment_from(const py::object& word) {
    return Keywords::choice<Alignment>(
        "alignment", word,
        {{"none", Alignment::none}, {"rigid", Alignment::rigid}, {"similarity", Alignment::similarity}});
}

HandleMarking take_marking(Keywords& keywords, const SurfaceObject& source, const SurfaceObject& target) {
    HandleMarking marking;
    if (const py::object word = keywords.taken("alignment")) marking.alignment = alignment_from(word);
    if (const py::object start = keywords.taken("start"); start && !start.is_none())
        marking.start = points_of(start, "start", source.vertex_count(), 3);
    if (const py::object paths = keywords.taken("paths"))
        marking.paths = vertex_lists(paths, "paths", source.vertex_count());
    if (const py::object images = keywords.taken("images"))
        marking.images = vertex_lists(images, "images", target.vertex_count());
    if (const py::object twists = keywords.taken("twists"))
        for (const py::handle item : twists) {
            if (!py::isinstance<py::sequence>(item) || py::len(item) != 2)
                throw py::type_error("twists are (path, turns)");
            const py::sequence pair = py::reinterpret_borrow<py::sequence>(item);
            marking.twists.push_back({vertex_list(pair[0], "the path of a twist", source.vertex_count()),
                                      value_of<int>(pair[1], "turns are a whole number")});
        }
    return marking;
}

namespace {

class HyperbolicMapObject final : public CarriedObject {
  public:
    HyperbolicMapObject(const SurfacePtr& source, HandleRegistration found, Record record)
        : CarriedObject(source, "registration", found.map, found.map.distortion, std::move(record)),
          found_(std::move(found)) {}
    const HandleRegistration& found() const { return found_; }
    const HyperbolicMap& map() const { return found_.map; }

  private:
    HandleRegistration found_;
};
using HyperbolicMapPtr = std::shared_ptr<HyperbolicMapObject>;

HyperbolicMapPtr object_of(const ShapeObject& source, HandleRegistration found, double begun) {
    Record record = space_record(source.surface, "register", map_record(found.map), found.map.warnings);
    record.solve = solve_record(found.map, seconds() - begun);
    record.registration = registration_record(found, source.shape, "");
    return std::make_shared<HyperbolicMapObject>(source.surface, std::move(found), std::move(record));
}

HyperbolicMapPtr registered(const py::object& source, const py::object& target, const py::kwargs& given) {
    const ShapePtr from = shape_from(source), to = shape_from(target);
    Interruption interruption;
    HyperbolicMapOptions options;
    Keywords keywords(given);
    HandleMarking marking = take_marking(keywords, *from->surface, *to->surface);
    bool search = false;
    keywords.take("search", search);
    if (search) marking.search.emplace();
    keywords.iteration(interruption, options);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        std::unique_lock first(from->mutex, std::defer_lock), second(to->mutex, std::defer_lock);
        if (to == from)
            first.lock();
        else
            std::lock(first, second);
        return object_of(*from, register_handles(from->shape, to->shape, marking, options), begun);
    });
}

void require_fits(const EquivariantMap& map, const ShapeObject& source, const ShapeObject& target) {
    const auto edges = static_cast<std::size_t>(source.surface->surface.topology.edge_count());
    const auto loops = target.shape.forms().homology.size();
    bool good = map.steps.size() == edges && map.classes.rows() == static_cast<Eigen::Index>(edges) &&
                map.classes.cols() == loops && map.bases.size() == map.frames.size() &&
                static_cast<int>(map.bases.size()) == source.surface->vertex_count();
    for (const int v : map.bases) good = good && v >= 0 && v < target.surface->vertex_count();
    if (!good) throw Error(Cause::bad_option, "the start is a map of another surface, or to another one");
}

HyperbolicMapPtr mapped(const ShapePtr& source, const ShapePtr& target, const EquivariantMap& start,
                        const py::kwargs& given) {
    require_fits(start, *source, *target);
    Interruption interruption;
    HyperbolicMapOptions options;
    Keywords keywords(given);
    keywords.iteration(interruption, options);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        const std::lock_guard lock(source->mutex);
        HandleRegistration found;
        found.map = hyperbolic_map(source->shape, target->shape, start, options);
        return object_of(*source, std::move(found), begun);
    });
}

py::tuple marking_tuple(Marking marking) {
    return py::make_tuple(std::move(marking.map), marking.mended, marking.defect);
}

/// Of the map to the target's faces, from which an inverse class is told.
void require_places(const HyperbolicMapObject& map, const ShapeObject& source, const ShapeObject& target) {
    if (map.source() != source.surface) throw Error(Cause::bad_option, "the map is not one of this source");
    require_on(target.surface->surface.mesh, map.places());
}

void bind_classes(py::module_& m) {
    py::class_<EquivariantMap>(
        m, "EquivariantMap",
        "A homotopy class of maps to a closed surface, as a map in it: where hyperbolic_map starts.")
        .def_property_readonly(
            "classes", [](const EquivariantMap& map) { return map.classes; },
            "#E×2g: what the target's closed forms add up to along the images of the edges")
        .def_property_readonly(
            "bases", [](const EquivariantMap& map) { return index_array(map.bases); }, "#V vertices of the target")
        .def("__repr__", [](const EquivariantMap& map) {
            return "<beltrami.EquivariantMap: " + std::to_string(map.bases.size()) + " vertices>";
        });
    constexpr const char* kMarkingTuple =
        "Returns the EquivariantMap, how many faces around which images did not close up were mended, and the "
        "defect.\n\nRaises BadMesh, BadOption where the images contradict each other.";
    m.def(
        "marking_by_vertices",
        [](const ShapePtr& source, const ShapePtr& target, const py::object& images) {
            const std::vector<int> list = vertex_list(images, "images", target->surface->vertex_count());
            if (static_cast<int>(list.size()) != source->surface->vertex_count())
                throw Error(Cause::bad_option, "images are not one vertex of the target for each of the source");
            return marking_tuple(without_lock([&] {
                return marking_by_vertices(source->surface->surface, source->shape.metric().original,
                                           target->shape.group(), list);
            }));
        },
        py::arg("source"), py::arg("target"), py::arg("images"),
        (std::string(
             "The class of a map between two HyperbolicShape that takes every vertex near a vertex of the target "
             "(#V, nearest_vertices).\n\n") +
         kMarkingTuple)
            .c_str());
    m.def(
        "marking_by_loops",
        [](const ShapePtr& source, const ShapePtr& target, const py::object& paths, const py::object& images) {
            const auto from = vertex_lists(paths, "paths", source->surface->vertex_count());
            const auto to = vertex_lists(images, "images", target->surface->vertex_count());
            return marking_tuple(without_lock([&] {
                return marking_by_loops(source->surface->surface, source->shape.metric().original,
                                        target->shape.group(), from, to);
            }));
        },
        py::arg("source"), py::arg("target"), py::arg("paths"), py::arg("images"),
        (std::string("The class that takes loops to loops: 2g closed paths of vertices through one vertex that cut the "
                     "source open (HyperbolicDomain.paths), and as many of the target.\n\n") +
         kMarkingTuple)
            .c_str());
    m.def(
        "inverse_marking",
        [](const ShapePtr& source, const ShapePtr& target, const HyperbolicMapObject& map) {
            require_places(map, *source, *target);
            return marking_tuple(
                without_lock([&] { return inverse_marking(source->shape, target->shape, map.map()); }));
        },
        py::arg("source"), py::arg("target"), py::arg("map"),
        (std::string("The class of the inverse of a HyperbolicMap from source to target.\n\n") + kMarkingTuple)
            .c_str());
    m.def(
        "twisted",
        [](const ShapePtr& source, const EquivariantMap& map, const py::object& path, int turns) {
            if (map.steps.size() != static_cast<std::size_t>(source->surface->surface.topology.edge_count()))
                throw Error(Cause::bad_option, "the map is one of another surface");
            if (std::abs(turns) > 1000) throw Error(Cause::bad_option, "more than a thousand turns are not resolved");
            return twisted(source->surface->surface, source->shape.metric().original, map,
                           vertex_list(path, "path", source->surface->vertex_count()), turns);
        },
        py::arg("source"), py::arg("map"), py::arg("path"), py::arg("turns") = 1,
        "The class after so many Dehn twists of the source about a simple closed path of vertices, to the left if "
        "positive.\n\nRaises BadOption.");
    m.def(
        "nearest_vertices",
        [](const SurfacePtr& target, const py::object& points) {
            require_triangles(target->surface);
            return index_array(
                nearest_vertices(target->surface.mesh, target->surface.mesh.faces, points_of(points, "points", 3)));
        },
        py::arg("target"), py::arg("points"),
        "The vertices of a surface of triangles nearest to n×3 points: n.\n\nRaises BadMesh, BadOption.");
    m.def(
        "homology_bound",
        [](const ShapePtr& source, const ShapePtr& target, const Eigen::MatrixXi& homology) {
            const int n = source->shape.forms().homology.size();
            if (homology.rows() != n || homology.cols() != target->shape.forms().homology.size())
                throw Error(Cause::bad_option, "homology is no matrix of source's loops and target's forms");
            return homology_bound(source->shape, target->shape, homology);
        },
        py::arg("source"), py::arg("target"), py::arg("homology"),
        "The least dilatation that a class can have for what it does to energies of harmonic forms.\n\nhomology: 2g×2g "
        "integers as HyperbolicMap.homology. Raises BadOption unless it keeps intersection numbers.");
    m.def(
        "aligned",
        [](const Mesh& source, const Mesh& target, const std::string& how) {
            const Alignment alignment = alignment_from(py::str(how));
            return without_lock([&] { return aligned(source, target, alignment); });
        },
        py::arg("source"), py::arg("target"), py::arg("how") = "rigid",
        "#V×3 vertices of a mesh after the rotation that brings it nearest to another one (iterated closest "
        "points).\n\n"
        "how: \"none\", \"rigid\" or \"similarity\". Raises BadMesh where a mesh has no faces.");
}

void bind_maps_of_handles(py::module_& m) {
    const auto field = [](auto member) { return [member](const HyperbolicMapObject& o) { return o.map().*member; }; };
    py::class_<HyperbolicMapObject, CarriedObject, HyperbolicMapPtr>(
        m, "HyperbolicMap", "The extremal map between two closed surfaces of genus 2 or more in a class.")
        .def_property_readonly("k", field(&HyperbolicMap::k), "An estimate of k*")
        .def_property_readonly("K", field(&HyperbolicMap::K), "An estimate of K*")
        .def_property_readonly("K_lower", field(&HyperbolicMap::K_lower), "An estimate of a lower bound of K*")
        .def_property_readonly("K_upper", field(&HyperbolicMap::K_upper), "An estimate of an upper bound of K*")
        .def_property_readonly("K_homology", field(&HyperbolicMap::K_homology),
                               "No map in the class has less, up to the mesh")
        .def_property_readonly(
            "phi", [](const py::object& self) { return view(self.cast<const HyperbolicMapObject&>().map().phi, self); },
            "#S values of the quadratic differential, in the samples' frames")
        .def_property_readonly("homology", field(&HyperbolicMap::homology),
                               "2g×2g: periods of the target's forms (columns) around images of the source's loops")
        .def_property_readonly("energy", field(&HyperbolicMap::energy), "Of the harmonic map of the class")
        .def_property_readonly("history", field(&HyperbolicMap::history))
        .def_property_readonly("equivariant", field(&HyperbolicMap::equivariant), "The map as an EquivariantMap")
        .def_property_readonly(
            "mended", [](const HyperbolicMapObject& o) { return o.found().mended; },
            "Faces around which nearest points did not close up")
        .def_property_readonly(
            "inverse_k", [](const HyperbolicMapObject& o) { return o.found().inverse_k; },
            "k of the extremal map back, an estimate of the meshes' error; None if not found");
    constexpr const char* kIteration =
        "Options: tolerance=0 (0: 1e-6), max_iterations=60, anderson_window=5, progress=None.\n\nRaises BadMesh, "
        "BadOption, NotSolved, Cancelled.";
    m.def("hyperbolic_map", &mapped, py::arg("source"), py::arg("target"), py::arg("start"),
          (std::string("The extremal map between two HyperbolicShape in the class of an EquivariantMap, by Hamilton's "
                       "iteration over the 3g − 3 differentials of the source.\n\n") +
           kIteration)
              .c_str());
    m.def("register_handles", &registered, py::arg("source"), py::arg("target"),
          (std::string("The extremal map of a closed surface of genus 2 or more onto another one (Surface or "
                       "HyperbolicShape).\n\n") +
           kMarking + " search=True: the class is sought, without a proof that none is better.\n\n" + kIteration)
              .c_str());
    m.def(
        "hyperbolic_distance_of",
        [](const HyperbolicMapObject& there, const HyperbolicMapObject& back) {
            return hyperbolic_distance_of(there.map(), back.map());
        },
        py::arg("there"), py::arg("back"), "The Distance of two maps, each of one surface onto the other.");
    m.def(
        "handle_distances",
        [](const std::vector<SurfacePtr>& surfaces, const std::string& alignment,
           const std::optional<py::function>& progress, const std::vector<std::string>& names, bool search) {
            const Alignment how = alignment_from(py::str(alignment));
            const std::vector<Surface> list = surfaces_of(surfaces, names);
            Interruption interruption;
            std::function<bool(int, int)> tell;
            if (progress) tell = [&](int done, int all) { return interruption.call(*progress, done, all); };
            std::optional<ClassSearchOptions> sought;
            if (search) sought.emplace();
            DistanceMatrix found =
                without_lock(interruption, [&] { return handle_distances(list, how, tell, names, sought); });
            return py::make_tuple(std::move(found.distance), std::move(found.lower), std::move(found.upper),
                                  pairs_array(found.unsettled));
        },
        py::arg("surfaces"), py::arg("alignment") = "none", py::arg("progress") = py::none(),
        py::arg("names") = std::vector<std::string>(), py::arg("search") = false,
        "All distances of closed surfaces of one genus, 2 or more, each in the class of nearest points after an "
        "alignment, or with search=True in a class that is sought: n×n distances, lower and upper bounds, and the m×2 "
        "pairs that have not settled.\n\n"
        "progress(done, all) is called after each pair.\n\nRaises BadMesh, BadOption, NotSolved naming a pair, "
        "Cancelled.");
}

}  // namespace

void bind_hyperbolic(py::module_& m) {
    bind_classes(m);
    bind_maps_of_handles(m);
}

}  // namespace beltrami::python
