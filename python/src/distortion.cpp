#include <beltrami/mesh/diagnosis.h>
#include <beltrami/operators/distortion.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

namespace {

Distortion measured(const SurfacePtr& surface, const py::object& image) {
    const Operators& operators = surface->surface.operators;
    const py::array array = py::array::ensure(image);
    if (array && array.ndim() == 2 && array.shape(1) == 3) {
        Mesh there;
        there.positions = points(image, "image");
        there.faces = surface->surface.mesh.faces;
        if (there.vertex_count() != surface->vertex_count())
            throw Error(Cause::bad_option,
                        "image has " + std::to_string(there.vertex_count()) + " points, and there are " +
                            std::to_string(surface->vertex_count()) + " vertices",
                        "give one for each");
        if (is_planar(there)) return distortion(operators, Positions(there.positions.leftCols(2)));
        return distortion(operators, there.positions, vertex_normals(there));
    }
    PyErr_Clear();
    return distortion(operators, map_of(*surface, image, "image"));
}

}  // namespace

void bind_distortion(py::module_& m) {
    py::class_<Distortion>(m, "Distortion", "What a map does to its source, face by face.")
        .def_property_readonly(
            "mu", [](const py::object& self) { return view(self.cast<const Distortion&>().mu, self); },
            "#S Beltrami coefficient at the samples, in their frames")
        .def_property_readonly(
            "face_mu", [](const py::object& self) { return view(self.cast<const Distortion&>().face_mu, self); },
            "#F means over the faces")
        .def_property_readonly(
            "face_abs_mu",
            [](const py::object& self) { return view(self.cast<const Distortion&>().face_abs_mu, self); },
            "#F largest |μ| of every face; above 1 where it is flipped, NaN where undefined")
        .def_readonly("mean", &Distortion::mean, "of |μ|, weighted by source area")
        .def_readonly("standard_deviation", &Distortion::standard_deviation)
        .def_readonly("p99", &Distortion::p99)
        .def_readonly("max", &Distortion::max)
        .def_property_readonly(
            "flipped", [](const Distortion& d) { return index_array(d.flipped); }, "Faces")
        .def_property_readonly(
            "degenerate", [](const Distortion& d) { return index_array(d.degenerate); }, "Faces that collapse")
        .def_property_readonly("K_max", &Distortion::K_max, "Infinite where faces are flipped")
        .def("__repr__", [](const Distortion& d) {
            return "<beltrami.Distortion: K_max " + std::to_string(d.K_max()) + ", mean |mu| " +
                   std::to_string(d.mean) + ", " + std::to_string(d.flipped.size()) + " flipped>";
        });
    constexpr const char* kMeasure =
        "Distortion of any map of the surface.\n\nimage: #V complex or #V×2 images in the plane, or #V×3 in space, "
        "judged there by its own normals.\n\nRaises BadOption if there is not one image for each vertex.";
    m.def("distortion", &measured, py::arg("surface"), py::arg("image"), kMeasure);
    m.def("measure", &measured, py::arg("surface"), py::arg("image"), kMeasure);
    m.def(
        "distortion_to_corners",
        [](const SurfacePtr& surface, const py::object& corners) {
            const Positions at = points(corners, "corners");
            if (at.rows() != surface->surface.mesh.faces.corner_count() || at.cols() != 2)
                throw Error(Cause::bad_option, "corners are not one point of the plane for each corner of a face");
            return distortion_to_corners(surface->surface.mesh, at);
        },
        py::arg("surface"), py::arg("corners"),
        "The same for a planar image given per face corner (#corners×2), such as texture_corners: seams are allowed.");
    m.def(
        "distortion_to",
        [](const Mesh& source, const Mesh& image) {
            if (!(source.faces == image.faces) || source.vertex_count() != image.vertex_count())
                throw Error(Cause::bad_mesh, "the two meshes have not the same faces");
            require_sound(source);
            return distortion_to(source, image);
        },
        py::arg("source"), py::arg("image"),
        "Distortion of the map between two meshes with the same faces.\n\nRaises BadMesh.");
    m.def(
        "mu_statistics",
        [](const py::object& mu, const py::object& weights) {
            const Eigen::VectorXcd list = complex_numbers(mu, "mu");
            const Eigen::VectorXd by = real_numbers(weights, "weights");
            if (by.size() != list.size() || list.size() == 0 || !by.allFinite() || !(by.array() > 0).all())
                throw Error(Cause::bad_option, "weights are not one positive number for each coefficient");
            const MuStatistics found = mu_statistics(list, {by.begin(), by.end()});
            return py::make_tuple(found.mean, found.standard_deviation, found.p99, found.max);
        },
        py::arg("mu"), py::arg("weights"),
        "Mean, standard deviation, 99th percentile and maximum of |μ| at n samples with n positive weights.\n\nRaises "
        "BadOption.");
    m.def(
        "beltrami_coefficient",
        [](const SurfacePtr& surface, const py::object& map) {
            return beltrami_coefficient(surface->surface.operators, map_of(*surface, map));
        },
        py::arg("surface"), py::arg("map"), "μ = ∂̄f/∂f of a map to the plane at every sample (#S), in its frame.");
    m.def("dilatation", &dilatation, py::arg("abs_mu"), "K = (1+|μ|)/|1−|μ||.");
    m.def("k_of", &k_of, py::arg("K"), "k = (K−1)/(K+1).");
    m.def("change_frame", &change_frame, py::arg("mu"), py::arg("angle"), "μ in a frame turned by an angle (radians).");
    m.def("compose_coefficients", &compose_coefficients, py::arg("mu_f"), py::arg("mu_g"), py::arg("d_z_f"),
          "Coefficient of g∘f from those of f and g (at the image) and ∂f.");
    m.def("decompose_coefficients", &decompose_coefficients, py::arg("mu_f"), py::arg("mu_g"), py::arg("d_z_f"),
          "Coefficient, at f(z), of g∘f⁻¹.");
}

}  // namespace beltrami::python
