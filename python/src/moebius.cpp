#include <cmath>

#include <beltrami/charts/circle_matching.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/plane/disk_moebius.h>

#include "charts.h"
#include "module.h"

namespace beltrami::python {

namespace {

void require_in_disk(Complex z, const char* name) {
    if (!(std::abs(z) < 1)) throw Error(Cause::bad_option, std::string(name) + " does not lie within the unit disk");
}

std::vector<PlacePair> place_pairs(const py::object& source, const py::object& target) {
    const std::vector<Complex> from = complex_list(source, "source"), to = complex_list(target, "target");
    if (from.size() != to.size())
        throw Error(Cause::bad_option, "there are " + std::to_string(from.size()) + " places of the source and " +
                                           std::to_string(to.size()) + " of the target");
    std::vector<PlacePair> pairs;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!(std::abs(from[i]) <= 1 + 1e-9 && std::abs(to[i]) <= 1 + 1e-9))
            throw Error(Cause::bad_option, "place " + std::to_string(i) + " does not lie in the unit disk", {},
                        {Things::points, {static_cast<int>(i)}});
        pairs.push_back({from[i], to[i]});
    }
    return pairs;
}

}  // namespace

void bind_moebius(py::module_& m) {
    py::class_<DiskMoebius>(m, "DiskMoebius", "The Möbius map z ↦ e^{iα} (z − a)/(1 − āz) of the unit disk to itself.")
        .def(py::init([](double rotation, Complex centre) {
                 require_in_disk(centre, "centre");
                 return DiskMoebius{rotation, centre};
             }),
             py::arg("rotation") = 0.0, py::arg("centre") = Complex(0),
             "rotation: α, radians. centre: a, what goes to 0.\n\nRaises BadOption unless |a| < 1.")
        .def_readonly("rotation", &DiskMoebius::rotation)
        .def_readonly("centre", &DiskMoebius::centre)
        .def(
            "__call__",
            [](const DiskMoebius& map, const py::object& places) { return map(complex_numbers(places, "places")); },
            py::arg("places"), "Images of n complex or n×2 places.")
        .def(
            "hole", [](const DiskMoebius& map, const py::object& hole) { return hole_tuple(map(hole_from(hole))); },
            py::arg("hole"), "The image of a circle within the disk, (loop, centre, radius).")
        .def("__repr__", [](const DiskMoebius& map) {
            return "<beltrami.DiskMoebius: rotation " + std::to_string(map.rotation) + ", centre " +
                   std::to_string(map.centre.real()) + " + " + std::to_string(map.centre.imag()) + "i>";
        });
    m.def(
        "centring", [](const py::object& hole) { return centring(hole_from(hole)); }, py::arg("hole"),
        "The DiskMoebius that takes a circle, (centre, radius) or (loop, centre, radius), to one around 0.");
    m.def(
        "hyperbolic_circle",
        [](const py::object& hole) {
            const HyperbolicCircle circle = hyperbolic_circle(hole_from(hole));
            return py::make_tuple(circle.centre, circle.radius);
        },
        py::arg("hole"),
        "Centre and radius of a circle within the unit disk in the hyperbolic metric 2|dz|/(1 − |z|²).");
    m.def(
        "hyperbolic_gap",
        [](Complex z, Complex w) {
            require_in_disk(z, "z");
            require_in_disk(w, "w");
            return hyperbolic_gap(z, w);
        },
        py::arg("z"), py::arg("w"), "sinh² of half the hyperbolic distance in the unit disk.\n\nRaises BadOption.");
    m.def(
        "best_move",
        [](const py::object& source, const py::object& target) { return best_move(place_pairs(source, target)); },
        py::arg("source"), py::arg("target"),
        "The DiskMoebius that brings n places of the unit disk nearest to n others, in the hyperbolic "
        "metric.\n\nRaises "
        "BadOption.");
    m.def(
        "best_rotation",
        [](const py::object& source, const py::object& target) { return best_rotation(place_pairs(source, target)); },
        py::arg("source"), py::arg("target"), "The same among rotations.");
    m.def(
        "centre_in_disk",
        [](const py::object& points, const py::object& weights) {
            Eigen::VectorXcd list = complex_numbers(points, "points");
            Eigen::VectorXd by = weights.is_none() ? Eigen::VectorXd(Eigen::VectorXd::Ones(list.size()))
                                                   : real_numbers(weights, "weights");
            if (by.size() != list.size() || list.size() == 0 || !by.allFinite() || !(by.array() > 0).all())
                throw Error(Cause::bad_option, "weights are not one positive number for each point");
            for (const Complex z : list)
                if (!(std::abs(z) <= 1 + 1e-9)) throw Error(Cause::bad_option, "points do not lie in the unit disk");
            centre_in_disk(list, by);
            return list;
        },
        py::arg("points"), py::arg("weights") = py::none(),
        "n points of the unit disk after the Möbius map that brings their weighted mean to 0.\n\nweights: n positive "
        "numbers. Raises BadOption.");
}

}  // namespace beltrami::python
