#include <beltrami/applications/deformed_picture.h>
#include <beltrami/applications/image_domain.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

using Pixels = py::array_t<std::uint8_t, py::array::c_style>;

/// Rows from top to bottom: h×w×4 numbers of 8 bits, or h×w×3, which are opaque.
Picture picture_from(const py::object& object) {
    if (!py::isinstance<py::array_t<std::uint8_t>>(object))
        throw py::type_error("a picture is an array of numpy.uint8");
    const Pixels pixels(py::reinterpret_borrow<py::array>(object));
    if (pixels.ndim() != 3 || (pixels.shape(2) != 3 && pixels.shape(2) != 4) || pixels.size() == 0)
        throw Error(Cause::bad_option, "a picture has h×w×4 or h×w×3 numbers");
    Picture picture{static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)), {}};
    const auto channels = static_cast<std::size_t>(pixels.shape(2));
    const std::size_t count = static_cast<std::size_t>(pixels.size()) / channels;
    picture.rgba.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* const from = pixels.data() + channels * i;
        picture.rgba.insert(picture.rgba.end(), from, from + 3);
        picture.rgba.push_back(channels == 4 ? from[3] : 255);
    }
    return picture;
}

Pixels pixels_of(const Picture& picture) {
    Pixels pixels({py::ssize_t{picture.height}, py::ssize_t{picture.width}, py::ssize_t{4}});
    std::copy(picture.rgba.begin(), picture.rgba.end(), pixels.mutable_data());
    return pixels;
}

}  // namespace

void bind_pictures(py::module_& m) {
    m.def(
        "deformed_picture",
        [](const py::object& pixels, const SurfacePtr& surface, const py::object& map, Complex low, Complex high,
           int width, bool smooth) {
            const Picture picture = picture_from(pixels);
            const Eigen::VectorXcd images = map_of(*surface, map);
            return pixels_of(without_lock([&] {
                return deformed_picture(picture, surface->surface, images, {{low, high}, width, smooth});
            }));
        },
        py::arg("picture"), py::arg("surface"), py::arg("map"), py::arg("low"), py::arg("high"), py::arg("width") = 800,
        py::arg("smooth") = true,
        "A picture that lies on a surface in the plane, deformed with it: h×w×4 numpy.uint8 (sRGB and opacity, rows "
        "from top to bottom).\n\npicture: h×w×4 or h×w×3 numpy.uint8. map: #V images in the plane. low, high: the "
        "corners of the rectangle on which the picture lies. width: pixels of the result. smooth=False: linear on the "
        "triangles.\n\nRaises BadMesh unless the surface lies in a plane z = const; BadOption. Source: Weber, Myles & "
        "Zorin 2012, figure 14.");
    m.def(
        "image_domain",
        [](const SurfacePtr& surface, const py::object& map) {
            const Eigen::VectorXcd images = map_of(*surface, map);
            return without_lock([&] { return image_domain(surface->surface, images); });
        },
        py::arg("surface"), py::arg("map"),
        "The TargetDomain that the boundary of a map to the plane bounds.\n\nmap: #V.\n\nRaises BadMesh unless the "
        "surface has one component, genus 0 and a boundary; BadBoundary, naming the vertices of a loop whose image "
        "meets itself; BadOption.");
}

}  // namespace beltrami::python
