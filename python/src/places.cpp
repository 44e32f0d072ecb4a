#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "module.h"

namespace beltrami::python {

void require_on(const Mesh& mesh, const Places& places) {
    std::vector<int> bad;
    for (std::size_t i = 0; i < places.points.size(); ++i) {
        const MeshPoint& place = places.points[i];
        bool good = place.face >= 0 && place.face < mesh.face_count();
        if (good) {
            const std::span<const int> face = mesh.faces[place.face];
            for (int j = 0; j < 3; ++j)
                good = good && std::isfinite(place.barycentric[j]) &&
                       std::find(face.begin(), face.end(), place.vertices[j]) != face.end();
        }
        if (!good) bad.push_back(static_cast<int>(i));
    }
    if (!bad.empty())
        throw Error(Cause::bad_option, "places are not on the mesh, the first is place " + std::to_string(bad[0]), {},
                    {Things::points, bad});
}

namespace {

Places places_from(const py::object& face, const py::object& vertices, const py::object& barycentric) {
    const std::vector<int> faces = whole_numbers(face, "face");
    const Eigen::MatrixXi corners = whole_table(vertices, "vertices", 3);
    const Positions weights = table(barycentric, "barycentric", static_cast<int>(faces.size()));
    if (corners.rows() != weights.rows() || weights.cols() != 3)
        throw Error(Cause::bad_option, "face, vertices and barycentric disagree about the number of places",
                    "give n faces, n×3 vertices and n×3 barycentric coordinates");
    Places places;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        MeshPoint point;
        point.face = faces[i];
        for (int j = 0; j < 3; ++j) {
            point.vertices[j] = corners(static_cast<Eigen::Index>(i), j);
            point.barycentric[j] = weights(static_cast<Eigen::Index>(i), j);
        }
        places.points.push_back(point);
    }
    return places;
}

py::array interpolate(const Places& places, const py::object& values) {
    py::array array = py::array::ensure(values);
    if (!array || array.ndim() < 1 || array.ndim() > 2) {
        PyErr_Clear();
        throw Error(Cause::bad_option, "values are no numbers of the vertices", "give #V or #V×m of them");
    }
    for (const MeshPoint& place : places.points)
        for (const int v : place.vertices)
            if (v < 0 || v >= array.shape(0))
                throw Error(Cause::bad_option,
                            "there are " + std::to_string(array.shape(0)) + " values, and a place at vertex " +
                                std::to_string(v),
                            "give one for each vertex of the mesh");
    const bool complex = array.dtype().kind() == 'c';
    const py::ssize_t columns = array.ndim() == 2 ? array.shape(1) : 1;
    const auto count = static_cast<Eigen::Index>(places.points.size());
    const auto combine = [&](auto zero) {
        using Number = decltype(zero);
        using Table = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const py::array_t<Number, py::array::c_style | py::array::forcecast> rows(
            py::reinterpret_borrow<py::object>(array));
        const Eigen::Map<const Table> from(rows.data(), rows.shape(0), columns);
        Table result = Table::Zero(count, columns);
        for (Eigen::Index i = 0; i < count; ++i)
            for (int j = 0; j < 3; ++j)
                result.row(i) += places.points[i].barycentric[j] * from.row(places.points[i].vertices[j]);
        return py::cast(std::move(result)).template cast<py::array>();
    };
    const py::array result = complex ? combine(Complex(0)) : combine(0.0);
    if (array.ndim() == 2) return result;
    return result.attr("reshape")(-1).cast<py::array>();
}

}  // namespace

void bind_places(py::module_& m) {
    py::class_<Places>(m, "Places", "n places of a mesh, each in a face.")
        .def(py::init(&places_from), py::arg("face"), py::arg("vertices"), py::arg("barycentric"),
             "From n faces, n×3 of their vertices and n×3 barycentric coordinates with respect to these.")
        .def_property_readonly(
            "face",
            [](const Places& places) {
                std::vector<int> faces;
                for (const MeshPoint& point : places.points) faces.push_back(point.face);
                return index_array(faces);
            },
            "n faces; -1: nowhere")
        .def_property_readonly(
            "vertices",
            [](const Places& places) {
                Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> result(places.points.size(), 3);
                for (std::size_t i = 0; i < places.points.size(); ++i)
                    for (int j = 0; j < 3; ++j) result(static_cast<Eigen::Index>(i), j) = places.points[i].vertices[j];
                return py::cast(std::move(result)).cast<py::array>();
            },
            "n×3 vertices of these faces")
        .def_property_readonly(
            "barycentric",
            [](const Places& places) {
                Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> result(places.points.size(), 3);
                for (std::size_t i = 0; i < places.points.size(); ++i)
                    for (int j = 0; j < 3; ++j)
                        result(static_cast<Eigen::Index>(i), j) = places.points[i].barycentric[j];
                return py::cast(std::move(result)).cast<py::array>();
            },
            "n×3 barycentric coordinates with respect to vertices")
        .def("interpolate", &interpolate, py::arg("values"),
             "Values there of a function that is linear between the vertices.\n\nvalues: #V or #V×m numbers, real or "
             "complex. Returns n or n×m.")
        .def("__len__", [](const Places& places) { return places.points.size(); })
        .def("__repr__",
             [](const Places& places) { return "<beltrami.Places: " + std::to_string(places.points.size()) + ">"; });
}

}  // namespace beltrami::python
