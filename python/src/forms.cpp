#include <beltrami/forms/cut_open.h>
#include <beltrami/forms/harmonic_basis.h>
#include <beltrami/forms/homology.h>
#include <beltrami/forms/period_matrix.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

namespace {

/// @throw Error bad_option unless the matrix is one of intersection numbers
void require_intersections(const Eigen::MatrixXi& matrix) {
    if (matrix.rows() != matrix.cols() || matrix.cast<double>() != -matrix.transpose().cast<double>())
        throw Error(Cause::bad_option, "intersections are no antisymmetric matrix");
    if (matrix.size() > 0 && (matrix.minCoeff() < -1000 || matrix.maxCoeff() > 1000))
        throw Error(Cause::bad_option, "intersections are far too large");
}

}  // namespace

void bind_forms(py::module_& m) {
    py::class_<HomologyBasis>(m, "HomologyBasis", "Loops that generate the first homology of a surface.")
        .def_property_readonly(
            "loops", [](const HomologyBasis& basis) { return index_lists(basis.loops); }, "Vertices of every loop")
        .def_readonly("lengths", &HomologyBasis::lengths, "Of the loops, in the surface's metric")
        .def_readonly("intersections", &HomologyBasis::intersections,
                      "#loops×#loops: +1 where loop j crosses loop i from right to left")
        .def_readonly("cochains", &HomologyBasis::cochains, "#E×#loops closed 1-forms dual to the loops")
        .def("__repr__", [](const HomologyBasis& basis) {
            return "<beltrami.HomologyBasis: " + std::to_string(basis.size()) + " loops>";
        });
    m.def(
        "homology_basis", [](const SurfacePtr& surface) { return homology_basis(surface->surface); },
        py::arg("surface"),
        "The shortest loops through a vertex (Erickson, Whittlesey 2005).\n\nRaises BadMesh unless there is one "
        "component.");
    m.def(
        "homology_class",
        [](const SurfacePtr& surface, const HomologyBasis& basis, const py::object& path) {
            const std::vector<int> vertices = vertex_list(path, "path", surface->vertex_count());
            if (basis.cochains.rows() != surface->surface.topology.edge_count())
                throw Error(Cause::bad_option, "the basis is that of another surface");
            return homology_class(surface->surface.topology, basis, vertices);
        },
        py::arg("surface"), py::arg("basis"), py::arg("path"),
        "The class of a closed path of vertices in terms of the loops.\n\nRaises BadOption naming two without an "
        "edge.");
    m.def(
        "harmonic_basis",
        [](const SurfacePtr& surface) {
            HarmonicBasis basis = without_lock([&] { return harmonic_basis(surface->surface); });
            return py::make_tuple(std::move(basis.forms), std::move(basis.energies), std::move(basis.homology));
        },
        py::arg("surface"), "The harmonic 1-forms dual to a homology basis: #E×n forms, n×n energies, the basis.");
    m.def(
        "period_matrix",
        [](const SurfacePtr& surface) {
            return without_lock(
                [&] { return period_matrix(surface->surface, harmonic_basis(surface->surface)).periods; });
        },
        py::arg("surface"),
        "g×g periods of the holomorphic 1-forms of a closed surface of genus g, with respect to "
        "symplectic_basis(homology_basis(surface).intersections).\n\nRaises BadMesh if it has a boundary or genus 0.");
    m.def(
        "symplectic_basis",
        [](const Eigen::MatrixXi& intersections) {
            require_intersections(intersections);
            return symplectic_basis(intersections);
        },
        py::arg("intersections"),
        "A basis in which the intersections of HomologyBasis have their normal form: columns a_1 … a_g, b_1 … b_g, "
        "then "
        "those of boundary loops, in terms of the loops; a_i·b_i = 1.\n\nintersections: n×n integers. Raises BadOption "
        "unless they are antisymmetric.");
    m.def(
        "wedge_products",
        [](const SurfacePtr& surface, const py::object& forms) {
            const Positions rows = table(forms, "forms", surface->surface.topology.edge_count());
            return wedge_products(surface->surface, rows);
        },
        py::arg("surface"), py::arg("forms"),
        "∫ α_i ∧ α_j of closed 1-forms, #E×n along the edges from the smaller vertex to the larger: n×n.\n\nRaises "
        "BadOption unless there are #E rows.");
    m.def(
        "cut_open",
        [](const SurfacePtr& surface) {
            CutOpen cut = without_lock([&] { return cut_open(surface->surface); });
            return py::make_tuple(std::move(cut.disk), index_array(cut.vertices));
        },
        py::arg("surface"),
        "Cuts a closed surface open along short edges into a disk: the Mesh of it, and the old vertex of each of its "
        "vertices.\n\nRaises BadMesh unless the surface is one component and closed. Source: Erickson, Har-Peled "
        "2004.");
}

}  // namespace beltrami::python
