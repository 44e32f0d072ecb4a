#pragma once

/// Arrays of NumPy, and whatever becomes one, as the library takes them. An array of the right type and layout is read
/// where it lies; others are converted first. Fields of results are views of these, which keep the result alive and
/// cannot be written.

#include <pybind11/eigen.h>

#include <span>

#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

#include "calls.h"

namespace beltrami::python {

/// Points: n×2 or n×3 numbers. @throw TypeError, or Error of @p cause with @p name in its sentence
Positions points(const py::object& object, const char* name, Cause cause = Cause::bad_option);
/// Faces: #F×3 or #F×4 whole numbers, −1 in the fourth column for triangles; or a list of lists.
/// @throw TypeError; Error bad_mesh naming faces with other numbers of corners or with vertices that do not exist
FaceList face_list(const py::object& object, int vertex_count);
/// Complex numbers: n of them, or n×2 reals.
Eigen::VectorXcd complex_numbers(const py::object& object, const char* name);
/// The same, of a wanted number. @p things are what they belong to, for the sentence
Eigen::VectorXcd complex_numbers(const py::object& object, const char* name, int count, const char* things);
std::vector<Complex> complex_list(const py::object& object, const char* name);
/// n real numbers.
Eigen::VectorXd real_numbers(const py::object& object, const char* name);
/// Real numbers, n or n×m, one row each of @p count.
Positions table(const py::object& object, const char* name, int count);
/// n whole numbers.
std::vector<int> whole_numbers(const py::object& object, const char* name);
/// n×columns of them.
Eigen::MatrixXi whole_table(const py::object& object, const char* name, int columns);
/// n×2 of them, as pairs.
std::vector<std::array<int, 2>> whole_pairs(const py::object& object, const char* name);
/// n vertices of a mesh. @throw Error bad_option naming those that do not exist
std::vector<int> vertex_list(const py::object& object, const char* name, int vertex_count);
/// Lists of vertices. @throw as vertex_list
std::vector<std::vector<int>> vertex_lists(const py::object& object, const char* name, int vertex_count);
/// rows×any complex numbers. @throw Error bad_option
Eigen::MatrixXcd complex_table(const py::object& object, const char* name, int rows);
/// Positions of wanted shape; z = 0 is added where @p columns is 3 and there are two. @throw Error bad_option
Positions points_of(const py::object& object, const char* name, int rows, int columns);
Positions points_of(const py::object& object, const char* name, int columns);

py::array pairs_array(const std::vector<std::array<int, 2>>& pairs);
py::array index_array(const std::vector<int>& values);
py::array flag_array(const std::vector<char>& values);
py::array number_array(const std::vector<double>& values);
py::array complex_array(const std::vector<Complex>& values);
/// n×4 parents of vertices, −1 where there are fewer.
py::array parents_array(const std::vector<std::array<int, 4>>& parents);
py::list index_lists(const std::vector<std::vector<int>>& lists);
/// Texture coordinates as Mesh(texture=…) takes them: points and corners.
py::tuple texture_tuple(const TextureCoordinates& texture);

/// A read-only view of a matrix or vector that belongs to @p owner.
template <class Matrix>
py::array view(const Matrix& matrix, const py::handle& owner) {
    return py::cast(&matrix, py::return_value_policy::reference_internal, owner).template cast<py::array>();
}

/// Places on a mesh, as arrays.
struct Places {
    std::vector<MeshPoint> points;
};
/// @throw Error bad_option naming places that are not on the mesh
void require_on(const Mesh& mesh, const Places& places);

}  // namespace beltrami::python
