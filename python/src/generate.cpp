#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/meshing/planar_domains.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

namespace {

Cells cells_of(const std::string& word) {
    return Keywords::choice<Cells>("cells", py::str(word), {{"triangles", Cells::triangles}, {"quads", Cells::quads}});
}

DomainOptions domain_options(const py::kwargs& given) {
    DomainOptions options;
    Keywords keywords(given);
    keywords.take("edge_length", options.edge_length);
    keywords.take("hole_edge_length", options.hole_edge_length);
    keywords.take("corner_edge_length", options.corner_edge_length);
    keywords.take("grading", options.grading);
    keywords.take("least_hole_edges", options.least_hole_edges);
    keywords.take("min_angle", options.min_angle);
    keywords.take("split_ears", options.split_ears);
    keywords.take("smoothing_passes", options.smoothing_passes);
    keywords.take("jitter", options.jitter.amplitude);
    keywords.take("seed", options.jitter.seed);
    keywords.finish();
    return options;
}

Polygon polygon(const py::object& object) {
    Polygon result;
    for (const Complex corner : complex_list(object, "a polygon")) result.emplace_back(corner.real(), corner.imag());
    return result;
}

constexpr const char* kDomainOptions =
    "Options: edge_length=0.05, hole_edge_length, corner_edge_length (0: edge_length), grading=0.3, "
    "least_hole_edges=16, min_angle=0.489 (radians), split_ears=True, smoothing_passes=6, jitter=0, seed=1.\n\n"
    "Raises BadOption naming holes that touch or leave the domain.";

}  // namespace

void bind_generate(py::module_& m) {
    m.def(
        "rectangle",
        [](double width, double height, int nx, int ny, const std::string& cells) {
            return rectangle(width, height, nx, ny, cells_of(cells));
        },
        py::arg("width"), py::arg("height"), py::arg("nx"), py::arg("ny"), py::arg("cells") = "triangles",
        "[0, width] × [0, height] in nx × ny cells; vertex (i, j) has the index j·(nx+1) + i. cells: \"triangles\" or "
        "\"quads\".");
    m.def(
        "torus",
        [](double major, double minor, int nu, int nv, const std::string& cells) {
            return torus(major, minor, nu, nv, cells_of(cells));
        },
        py::arg("major"), py::arg("minor"), py::arg("nu"), py::arg("nv"), py::arg("cells") = "triangles",
        "Torus of revolution about the z-axis, nu × nv cells; vertex (i, j) has the index i·nv + j.");
    m.def(
        "cylinder",
        [](double radius, double height, int nu, int nz, const std::string& cells) {
            return cylinder(radius, height, nu, nz, cells_of(cells));
        },
        py::arg("radius"), py::arg("height"), py::arg("nu"), py::arg("nz"), py::arg("cells") = "triangles",
        "Open cylinder about the z-axis; vertex (i, j) has the index i·(nz+1) + j.");
    m.def(
        "disk",
        [](int rings, double radius, double jitter, std::uint64_t seed) {
            return without_lock([&] { return disk(rings, radius, {jitter, seed}); });
        },
        py::arg("rings"), py::arg("radius") = 1.0, py::arg("jitter") = 0.0, py::arg("seed") = 1,
        "The disk in concentric rings: 6·rings² triangles, vertex 0 the centre, the last 6·rings vertices the "
        "boundary.\n\njitter: how far vertices are moved at random, in edges, at most 0.5. Returns a planar Mesh.");
    m.def("disk_rings_for_edge_length", &disk_rings_for_edge_length, py::arg("edge_length"), py::arg("radius") = 1.0,
          "Rings of a disk with edges of about that length.");
    m.def("disk_rings_for_triangles", &disk_rings_for_triangles, py::arg("triangles"),
          "Rings of a disk with about so many triangles.");
    m.def(
        "annulus",
        [](double inner, double outer, int around, int layers, double jitter, std::uint64_t seed) {
            return annulus(inner, outer, around, layers, {jitter, seed});
        },
        py::arg("inner"), py::arg("outer"), py::arg("around"), py::arg("layers") = 0, py::arg("jitter") = 0.0,
        py::arg("seed") = 1, "inner ≤ |z| ≤ outer with radii in geometric progression; layers=0: equilateral.");
    m.def("icosahedral_sphere", &icosahedral_sphere, py::arg("levels"), py::arg("radius") = 1.0,
          "Sphere of 20·4^levels triangles, 0 ≤ levels ≤ 11.");
    m.def("octahedral_sphere", &octahedral_sphere, py::arg("levels"), py::arg("radius") = 1.0,
          "Sphere of 8·4^levels triangles; vertices 0 … 5 are ±x, ±y, ±z.");
    m.def("double_torus", &double_torus, py::arg("edge_length") = 0.1, py::arg("scale") = 1.0,
          "A smooth closed surface of genus 2.");
    m.def(
        "circle_domain",
        [](double radius, const std::vector<std::tuple<Complex, double>>& holes, Complex centre,
           const py::kwargs& given) {
            const DomainOptions options = domain_options(given);
            std::vector<Circle> circles;
            for (const auto& [at, r] : holes) circles.push_back({{at.real(), at.imag()}, r});
            return without_lock([&] {
                return circle_domain({{centre.real(), centre.imag()}, radius}, circles, options);
            });
        },
        py::arg("radius") = 1.0, py::arg("holes") = std::vector<std::tuple<Complex, double>>(),
        py::arg("centre") = Complex(0),
        (std::string("A disk with round holes, each (centre, radius), centres complex: a planar Mesh.\n\n") +
         kDomainOptions)
            .c_str());
    m.def(
        "polygon_domain",
        [](const py::object& outer, const std::vector<py::object>& holes, const py::kwargs& given) {
            const DomainOptions options = domain_options(given);
            const Polygon around = polygon(outer);
            std::vector<Polygon> inside;
            for (const py::object& hole : holes) inside.push_back(polygon(hole));
            return without_lock([&] { return polygon_domain(around, inside, options); });
        },
        py::arg("outer"), py::arg("holes") = std::vector<py::object>(),
        (std::string("A polygon with polygonal holes, each n×2 or n complex corners: a planar Mesh.\n\n") +
         kDomainOptions)
            .c_str());
}

}  // namespace beltrami::python
