#include "arrays.h"

#include <algorithm>
#include <climits>
#include <cmath>

namespace beltrami::python {

namespace {

using Row = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& array) {
    std::string shape;
    for (py::ssize_t i = 0; i < array.ndim(); ++i) shape += (i ? "×" : "") + std::to_string(array.shape(i));
    return shape.empty() ? "a single number" : shape;
}

/// The array that an object is or becomes, of one of some kinds of numbers (NumPy's dtype.kind).
py::array array_from(const py::object& object, const char* name, const char* kinds, const char* what) {
    py::array array = py::array::ensure(object);
    if (!array) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + " is no array of numbers");
    }
    // An empty list has a type all the same.
    const bool untyped = array.size() == 0 && !py::isinstance<py::array>(object);
    const char kind = array.dtype().kind();
    if (!untyped && std::string(kinds).find(kind) == std::string::npos)
        throw py::type_error(std::string(name) + " holds " + py::str(array.dtype()).cast<std::string>() + ", not " +
                             what);
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        if (array.shape(i) > INT_MAX / 4)
            throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array),
                        "give less than half a billion");
    return array;
}

constexpr const char* kReals = "fiu";
constexpr const char* kComplex = "cfiu";
constexpr const char* kWhole = "iu";

int whole(std::int64_t value) {
    return static_cast<int>(std::clamp<std::int64_t>(value, INT_MIN, INT_MAX));
}

/// Whole numbers of any width, those beyond int at its ends: no vertex has such a number.
std::vector<int> whole_numbers_of(const py::array& array) {
    std::vector<int> result(static_cast<std::size_t>(array.size()));
    if (array.dtype().kind() == 'u' && array.itemsize() == 8) {
        const py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast> wide(
            py::reinterpret_borrow<py::object>(array));
        std::transform(wide.data(), wide.data() + wide.size(), result.begin(),
                       [](std::uint64_t value) { return static_cast<int>(std::min<std::uint64_t>(value, INT_MAX)); });
    } else if (array.dtype().kind() == 'i' && array.itemsize() == 4) {
        const py::array_t<int, py::array::c_style | py::array::forcecast> same(
            py::reinterpret_borrow<py::object>(array));
        std::copy(same.data(), same.data() + same.size(), result.begin());
    } else {
        const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(
            py::reinterpret_borrow<py::object>(array));
        std::transform(wide.data(), wide.data() + wide.size(), result.begin(), whole);
    }
    return result;
}

/// @throw Error naming the rows in which a number is not finite
void require_finite(const Positions& values, const char* name, Cause cause) {
    std::vector<int> rows;
    for (Eigen::Index i = 0; i < values.rows(); ++i)
        if (!values.row(i).allFinite()) rows.push_back(static_cast<int>(i));
    if (rows.empty()) return;
    const std::string which = std::to_string(rows[0]);
    throw Error(cause, std::string(name) + " has numbers that are not finite, the first in row " + which, {},
                {cause == Cause::bad_mesh ? Things::vertices : Things::points, std::move(rows)});
}

}  // namespace

Positions points(const py::object& object, const char* name, Cause cause) {
    const py::array array = array_from(object, name, kReals, "real numbers");
    if (array.ndim() != 2 || (array.shape(1) != 2 && array.shape(1) != 3))
        throw Error(cause, std::string(name) + " has the shape " + shape_of(array), "give n×2 or n×3 numbers");
    const Row rows(py::reinterpret_borrow<py::object>(array));
    Positions result = Eigen::Map<const Positions>(rows.data(), rows.shape(0), rows.shape(1));
    require_finite(result, name, cause);
    return result;
}

FaceList face_list(const py::object& object, int vertex_count) {
    FaceList faces;
    if (py::isinstance<py::list>(object) && py::len(object) > 0) {
        // Triangles and quads mixed are no array.
        bool mixed = false;
        const py::list rows(object);
        for (const py::handle row : rows) {
            if (!py::isinstance<py::sequence>(row)) {
                mixed = false;
                break;
            }
            mixed = mixed || py::len(row) != py::len(rows[0]);
        }
        if (mixed)
            for (const py::handle row : rows)
                faces.add(whole_numbers(py::reinterpret_borrow<py::object>(row), "a face"));
    }
    if (faces.empty()) {
        const py::array array = array_from(object, "F", kWhole, "whole numbers");
        const py::ssize_t columns = array.ndim() == 2 ? array.shape(1) : 0;
        if (columns != 3 && columns != 4)
            throw Error(Cause::bad_mesh, "F has the shape " + shape_of(array),
                        "give #F×3 vertex indices, or #F×4 with -1 in the fourth column of triangles");
        const std::vector<int> values = whole_numbers_of(array);
        const int count = static_cast<int>(array.shape(0));
        faces.reserve(count, static_cast<int>(std::min<std::size_t>(values.size(), INT_MAX)));
        for (int f = 0; f < count; ++f) {
            const int* face = values.data() + static_cast<std::size_t>(f) * static_cast<std::size_t>(columns);
            const bool triangle = columns == 3 || face[3] == -1;
            faces.add(std::span<const int>(face, triangle ? 3 : 4));
        }
    }
    std::vector<int> bad, degrees;
    for (int f = 0; f < faces.size(); ++f) {
        if (faces.degree(f) != 3 && faces.degree(f) != 4) degrees.push_back(f);
        if (std::any_of(faces[f].begin(), faces[f].end(), [&](int v) { return v < 0 || v >= vertex_count; }))
            bad.push_back(f);
    }
    if (!degrees.empty())
        throw Error(Cause::bad_mesh,
                    "faces are neither triangles nor quads, the first is face " + std::to_string(degrees[0]),
                    "cut them into triangles", {Things::faces, degrees});
    if (!bad.empty())
        throw Error(Cause::bad_mesh,
                    "faces name vertices that do not exist, the first is face " + std::to_string(bad[0]),
                    "vertices are counted from 0, and there are " + std::to_string(vertex_count), {Things::faces, bad});
    return faces;
}

Eigen::VectorXcd complex_numbers(const py::object& object, const char* name) {
    const py::array array = array_from(object, name, kComplex, "numbers");
    if (array.ndim() == 2 && array.shape(1) == 2 && array.dtype().kind() != 'c') {
        const Row rows(py::reinterpret_borrow<py::object>(array));
        Eigen::VectorXcd result(rows.shape(0));
        for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = {rows.at(i, 0), rows.at(i, 1)};
        return result;
    }
    if (array.ndim() != 1)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array),
                    "give n complex numbers or n×2 reals");
    const py::array_t<Complex, py::array::c_style | py::array::forcecast> row(
        py::reinterpret_borrow<py::object>(array));
    return Eigen::Map<const Eigen::VectorXcd>(row.data(), row.size());
}

Eigen::VectorXcd complex_numbers(const py::object& object, const char* name, int count, const char* things) {
    Eigen::VectorXcd result = complex_numbers(object, name);
    if (result.size() != count)
        throw Error(Cause::bad_option,
                    std::string(name) + " has " + std::to_string(result.size()) + " numbers, and there are " +
                        std::to_string(count) + " " + things,
                    "give one for each");
    return result;
}

std::vector<Complex> complex_list(const py::object& object, const char* name) {
    const Eigen::VectorXcd numbers = complex_numbers(object, name);
    return {numbers.begin(), numbers.end()};
}

Eigen::VectorXd real_numbers(const py::object& object, const char* name) {
    const py::array array = array_from(object, name, kReals, "real numbers");
    if (array.ndim() != 1)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array), "give n numbers");
    const Row row(py::reinterpret_borrow<py::object>(array));
    return Eigen::Map<const Eigen::VectorXd>(row.data(), row.size());
}

Positions table(const py::object& object, const char* name, int count) {
    const py::array array = array_from(object, name, kReals, "real numbers");
    if (array.ndim() < 1 || array.ndim() > 2 || array.shape(0) != count)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array),
                    "give " + std::to_string(count) + " rows");
    const Row rows(py::reinterpret_borrow<py::object>(array));
    return Eigen::Map<const Positions>(rows.data(), count, rows.ndim() == 2 ? rows.shape(1) : 1);
}

std::vector<int> whole_numbers(const py::object& object, const char* name) {
    const py::array array = array_from(object, name, kWhole, "whole numbers");
    if (array.ndim() != 1)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array), "give n whole numbers");
    return whole_numbers_of(array);
}

Eigen::MatrixXi whole_table(const py::object& object, const char* name, int columns) {
    const py::array array = array_from(object, name, kWhole, "whole numbers");
    if (array.size() == 0) return Eigen::MatrixXi(0, columns);
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array),
                    "give n×" + std::to_string(columns) + " whole numbers");
    const std::vector<int> values = whole_numbers_of(array);
    return Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        values.data(), array.shape(0), columns);
}

py::array pairs_array(const std::vector<std::array<int, 2>>& pairs) {
    py::array_t<int> result({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (int j = 0; j < 2; ++j) result.mutable_at(static_cast<py::ssize_t>(i), j) = pairs[i][j];
    return result;
}

py::array index_array(const std::vector<int>& values) {
    return py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array flag_array(const std::vector<char>& values) {
    py::array_t<bool> result(static_cast<py::ssize_t>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) result.mutable_at(static_cast<py::ssize_t>(i)) = values[i] != 0;
    return result;
}

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
