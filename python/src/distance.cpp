#include <beltrami/teichmuller/distance.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

struct Wanted {
    ExtremalOptions options;
    Correspondence correspondence;

    void take(const py::kwargs& given, Interruption& interruption, std::vector<const SurfaceObject*> surfaces) {
        Keywords keywords(given);
        take_extremal(keywords, interruption, std::move(surfaces), options);
        take_correspondence(keywords, correspondence);
        keywords.finish();
    }
};

Distance distance(const SurfacePtr& a, const SurfacePtr& b, int outer, bool both_ways, const py::kwargs& given) {
    require_loop(*a, outer);
    require_loop(*b, outer);
    Interruption interruption;
    Wanted wanted;
    wanted.take(given, interruption, {a.get(), b.get()});
    wanted.correspondence.outer_loop = outer;
    return without_lock(interruption, [&] {
        return teichmueller_distance(a->shape, b->shape, wanted.correspondence, wanted.options, outer, both_ways);
    });
}

py::tuple matrix(const std::vector<SurfacePtr>& surfaces, const std::vector<std::string>& names,
                 const std::optional<py::function>& progress, const py::kwargs& given) {
    Interruption interruption;
    Wanted wanted;
    wanted.take(given, interruption, {});
    const std::vector<Surface> list = surfaces_of(surfaces, names);
    std::function<bool(int, int)> tell;
    if (progress) tell = [&](int done, int all) { return interruption.call(*progress, done, all); };
    DistanceMatrix found = without_lock(
        interruption, [&] { return distance_matrix(list, wanted.correspondence, wanted.options, tell, names); });
    return py::make_tuple(std::move(found.distance), std::move(found.lower), std::move(found.upper),
                          pairs_array(found.unsettled));
}

}  // namespace

void bind_distance(py::module_& m) {
    py::class_<Distance>(m, "Distance", "Teichmüller's distance ½ log K* of two shapes, with its bracket.")
        .def_readonly("distance", &Distance::distance)
        .def_readonly("lower", &Distance::lower)
        .def_readonly("upper", &Distance::upper)
        .def_readonly("settled", &Distance::settled, "Every map has converged and is free of folds")
        .def("__float__", [](const Distance& d) { return d.distance; })
        .def("__repr__", [](const Distance& d) {
            return "<beltrami.Distance: " + std::to_string(d.distance) + " in [" + std::to_string(d.lower) + ", " +
                   std::to_string(d.upper) + "]>";
        });
    m.def("teichmueller_distance", &distance, py::arg("a"), py::arg("b"), py::arg("outer") = 0, py::kw_only(),
          py::arg("both_ways") = true,
          "Distance between two surfaces of genus 0 with as many boundary loops: of disks 0, of rings by their moduli, "
          "of "
          "others by the extremal map of each onto the other, whose boundary slides. Charts that the surfaces keep are "
          "used.\n\nouter: the loop that goes to the outer one. Options: those of extremal_map, and of Constraints for "
          "the "
          "correspondence.\n\nRaises BadMesh, BadBoundary, NotSolved, Cancelled.");
    m.def(
        "distance_matrix", &matrix, py::arg("surfaces"), py::arg("names") = std::vector<std::string>(),
        py::arg("progress") = py::none(),
        "All distances of some surfaces: n×n distances, lower and upper bounds, and the m×2 pairs whose maps have not "
        "settled.\n\nprogress(done, all) is called after each pair. beltrami.cohort does the same for files, on many "
        "machines.\n\nRaises BadMesh naming a shape, BadBoundary naming two, as extremal_map, Cancelled.");
    m.def(
        "cluster_by_distance",
        [](const py::object& distances) {
            const py::array array = py::array::ensure(distances);
            if (!array || array.ndim() != 2) {
                PyErr_Clear();
                throw Error(Cause::bad_option, "distances are no matrix");
            }
            const Positions values = table(distances, "distances", static_cast<int>(array.shape(0)));
            const std::vector<Merge> merges = cluster_by_distance(values);
            Positions result(merges.size(), 4);
            for (std::size_t i = 0; i < merges.size(); ++i)
                result.row(static_cast<Eigen::Index>(i)) << merges[i].a, merges[i].b, merges[i].height, merges[i].size;
            return result;
        },
        py::arg("distances"),
        "Agglomerative clustering by mean distances (average linkage): (n−1)×4 as scipy.cluster.hierarchy has it.\n\n"
        "Raises BadOption unless the matrix is square, symmetric and finite.");
}

}  // namespace beltrami::python
