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

std::vector<std::array<int, 2>> whole_pairs(const py::object& object, const char* name) {
    const Eigen::MatrixXi rows = whole_table(object, name, 2);
    std::vector<std::array<int, 2>> pairs;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) pairs.push_back({rows(i, 0), rows(i, 1)});
    return pairs;
}

std::vector<int> vertex_list(const py::object& object, const char* name, int vertex_count) {
    std::vector<int> list = whole_numbers(object, name), bad;
    for (const int v : list)
        if (v < 0 || v >= vertex_count) bad.push_back(v);
    if (!bad.empty())
        throw Error(Cause::bad_option, std::string(name) + ": there is no vertex " + std::to_string(bad[0]),
                    "vertices are counted from 0, and there are " + std::to_string(vertex_count),
                    {Things::vertices, bad});
    return list;
}

std::vector<std::vector<int>> vertex_lists(const py::object& object, const char* name, int vertex_count) {
    if (!py::isinstance<py::iterable>(object)) throw py::type_error(std::string(name) + " are lists of vertices");
    std::vector<std::vector<int>> lists;
    constexpr std::size_t most = 1 << 20;  // a broadcast array may be longer than any memory
    if (py::isinstance<py::sequence>(object) && py::len(object) > most)
        throw Error(Cause::bad_option, std::string(name) + " are " + std::to_string(py::len(object)) + " lists",
                    "give " + std::to_string(most) + " at most");
    for (const py::handle item : object)
        lists.push_back(vertex_list(py::reinterpret_borrow<py::object>(item), name, vertex_count));
    return lists;
}

Eigen::MatrixXcd complex_table(const py::object& object, const char* name, int rows) {
    const py::array array = array_from(object, name, kComplex, "numbers");
    if (array.ndim() != 2 || array.shape(0) != rows)
        throw Error(Cause::bad_option, std::string(name) + " has the shape " + shape_of(array),
                    "give " + std::to_string(rows) + " rows");
    using Table = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const py::array_t<Complex, py::array::c_style | py::array::forcecast> values(
        py::reinterpret_borrow<py::object>(array));
    return Eigen::Map<const Table>(values.data(), rows, values.shape(1));
}

Positions points_of(const py::object& object, const char* name, int rows, int columns) {
    Positions result = points_of(object, name, columns);
    if (result.rows() != rows)
        throw Error(Cause::bad_option, std::string(name) + " has " + std::to_string(result.rows()) +
                                           " rows, and is to have " + std::to_string(rows));
    return result;
}

Positions points_of(const py::object& object, const char* name, int columns) {
    Positions result = points(object, name);
    if (columns == 3 && result.cols() == 2) {
        result.conservativeResize(Eigen::NoChange, 3);
        result.col(2).setZero();
    }
    if (result.cols() != columns)
        throw Error(Cause::bad_option, std::string(name) + " is to have " + std::to_string(columns) + " columns");
    return result;
}

py::array number_array(const std::vector<double>& values) {
    return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array complex_array(const std::vector<Complex>& values) {
    return py::array_t<Complex>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array parents_array(const std::vector<std::array<int, 4>>& parents) {
    py::array_t<int> result({static_cast<py::ssize_t>(parents.size()), py::ssize_t{4}});
    for (std::size_t i = 0; i < parents.size(); ++i)
        for (int j = 0; j < 4; ++j) result.mutable_at(static_cast<py::ssize_t>(i), j) = parents[i][j];
    return result;
}

py::list index_lists(const std::vector<std::vector<int>>& lists) {
    py::list result;
    for (const std::vector<int>& list : lists) result.append(index_array(list));
    return result;
}

py::tuple texture_tuple(const TextureCoordinates& texture) {
    return py::make_tuple(texture.points, index_array(texture.corners));
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

}  // namespace beltrami::python
