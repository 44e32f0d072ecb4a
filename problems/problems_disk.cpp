// Simply connected problems in the plane.
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/operators/distortion.h>

#include "problems/construct.h"
#include "problems/elliptic.h"
#include "problems/outlines.h"
#include "support/meshes.h"

namespace beltrami::bench {

namespace {

Mesh unit_disk(double edge_length) {
    return disk(disk_rings_for_edge_length(edge_length));
}

Mesh unit_square(double edge_length) {
    const int n = std::max(2, static_cast<int>(std::lround(1 / edge_length)));
    return rectangle(1, 1, n, n);
}

Mesh polygon_mesh(const Polygon& outline, double edge_length, double corner_edge_length = 0) {
    DomainOptions options;
    options.edge_length = edge_length;
    options.corner_edge_length = corner_edge_length;
    return polygon_domain(outline, {}, options);
}

std::vector<Complex> to_complex(const Polygon& polygon) {
    std::vector<Complex> result;
    for (const auto& p : polygon) result.push_back({p.x(), p.y()});
    return result;
}

Problem with_boundary(std::string name, std::string statement, Mesh mesh, BoundaryCondition boundary) {
    Problem problem;
    problem.name = std::move(name);
    problem.statement = std::move(statement);
    problem.mesh = std::move(mesh);
    problem.boundary = std::move(boundary);
    return problem;
}

Problem lobes_on(std::string name, std::string mesh_kind, Mesh mesh) {
    return with_boundary_values(std::move(name),
                                "The circle around three lobes, r = 1 + 0.45 cos 3t at uneven speed" + mesh_kind,
                                std::move(mesh), test::three_lobes);
}

Problem arrow_head(std::string name, double push, double edge_length) {
    Mesh mesh = unit_square(edge_length);
    BoundaryCondition boundary;
    const std::vector<Complex> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    std::vector<int> vertices;
    for (const Complex c : corners) vertices.push_back(vertex_at(mesh, c));
    auto images = corners;
    images[2] -= Complex(push, push);
    pin_sides(boundary, mesh, topology(mesh).boundary_loops[0], vertices, images);
    return with_boundary(std::move(name),
                         "The unit square, its corner (1, 1) pushed in to the diagonal point " +
                             std::to_string(1 - push).substr(0, 4) + "; sides straight, even speed",
                         std::move(mesh), std::move(boundary));
}

}  // namespace

Problem exact_composition(double edge_length) {
    return with_exact_map("exact_composition",
                          "exp(0.6(g + ½ conj g)), g = z + 0.3z², on the unit disk: conformal, affine, conformal",
                          unit_disk(edge_length), test::exact_composition, 0.5);
}

Problem three_lobes(double edge_length) {
    return lobes_on("three_lobes", "", unit_disk(edge_length));
}

Problem three_lobes_jittered(double edge_length) {
    JitterOptions jitter;
    jitter.amplitude = 0.5;
    jitter.seed = 16;
    return lobes_on("three_lobes_jittered", "; every vertex displaced by up to half an edge",
                    disk(disk_rings_for_edge_length(edge_length), 1, jitter));
}

Problem three_lobes_graded(double edge_length) {
    DomainOptions options;
    options.edge_length = 1.5 * edge_length;
    options.grading = 0.5;
    options.min_angle = 0.2;
    for (const Complex at : {Complex(0.3, 0.2), Complex(-0.5, 0.4), Complex(0.1, -0.7)})
        options.sources.push_back({point(at), edge_length / 12});
    return lobes_on("three_lobes_graded", "; edges from h/12 at three places to 1.5h, angles down to 11 degrees",
                    circle_domain({}, {}, options));
}

Problem three_lobes_anisotropic(double edge_length) {
    // A mesh of an ellipse, stretched back to the disk: edges are five times longer along one direction.
    constexpr double ratio = 5;
    const int corners = static_cast<int>(std::ceil(2 * kPi / edge_length));
    const Complex along = std::polar(1.0, 0.5);
    Polygon outline;
    for (int i = 0; i < corners; ++i) {
        const Complex z = std::polar(1.0, 2 * kPi * i / corners) * std::conj(along);
        outline.push_back({z.real() / std::sqrt(ratio), z.imag() * std::sqrt(ratio)});
    }
    Mesh mesh = polygon_mesh(outline, edge_length);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z =
            along * Complex(mesh.positions(v, 0) * std::sqrt(ratio), mesh.positions(v, 1) / std::sqrt(ratio));
        mesh.positions.row(v) << z.real(), z.imag();
    }
    return lobes_on("three_lobes_anisotropic", "; edges five times longer along one direction", std::move(mesh));
}

Problem four_points(double edge_length) {
    const DiskRectangle from(kPi / 4), to(kPi / 8);
    const double across = to.width() / from.width(), up = to.height() / from.height();
    const double ratio = std::max(across / up, up / across);
    const auto f = [&](Complex z) {
        const Complex w = from.to_rectangle(z);
        return to.to_disk({across * w.real(), up * w.imag()});
    };
    // With rings a multiple of 4 the four points are vertices.
    const int rings = 4 * std::max(1, (disk_rings_for_edge_length(edge_length) + 2) / 4);
    return with_exact_map("four_points",
                          "The disk to itself, the boundary points ±π/4, π ± π/4 moved to ±π/8, π ± π/8; between them "
                          "the values of the extremal map (conformal to a rectangle, affine, conformal back)",
                          disk(rings), f, k_of(ratio));
}

Problem bean(double edge_length) {
    return with_boundary_values(
        "bean", "The disk to a bean at uneven speed; no map is known", unit_disk(edge_length), [](Complex z) {
            const double t = std::arg(z), s = t + 0.35 * std::sin(t - 0.6) + 0.2 * std::cos(2 * t);
            const Complex w = std::polar(1.0, s);
            return Complex(1.3 * w.real(), 0.6 * w.imag() + 0.55 * w.real() * w.real());
        });
}

Problem half_plane_square(double edge_length) {
    const Complex i(0, 1);
    Problem problem = with_exact_map(
        "half_plane_square", "|z|z on the upper half-plane, seen on the disk: extremal, not of Teichmüller type",
        unit_disk(edge_length),
        [&](Complex z) {
            if (std::abs(z - 1.0) < 1e-12) return Complex(1);
            const Complex w = i * (1.0 + z) / (1.0 - z), g = std::abs(w) * w;
            const Complex f = (g - i) / (g + i);
            return std::abs(z) > 1 - 1e-12 ? f / std::abs(f) : f;
        },
        1.0 / 3);
    problem.teichmuller = false;
    return problem;
}

Problem arrow_head_45(double edge_length) {
    return arrow_head("arrow_head_45", 0.45, edge_length);
}
Problem arrow_head_65(double edge_length) {
    return arrow_head("arrow_head_65", 0.65, edge_length);
}

Problem l_to_square(double edge_length) {
    Mesh mesh = polygon_mesh({{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}, edge_length);
    const Surface surface(mesh);
    // The reflex corner becomes a point of a side.
    BoundaryPlacement placement;
    placement.speed = BoundarySpeed::conformal;
    const auto boundary = boundary_to_rectangle(surface, 1, 1, std::array{0, 1, 4, 5}, placement);
    return with_boundary("l_to_square",
                         "An L-shape to a square; its reflex corner goes to the inside of a side; on the sides the "
                         "speed of the conformal map to a rectangle",
                         std::move(mesh), boundary);
}

Problem notched_disk(double edge_length) {
    Mesh mesh = polygon_mesh(notched_circle(5, 0.06, 0.45, 100), edge_length, edge_length / 2);
    BoundaryPlacement placement;
    placement.speed = BoundarySpeed::conformal;
    placement.start = 12;  // in the middle of an arc: away from corners, where conformal angles are least exact
    const auto boundary = boundary_to_disk(Surface(mesh), 0.5, placement);
    return with_boundary(
        "notched_disk",
        "A disk with five slit-like notches to the round disk, e^{i(t + ½ sin t)} of the conformal angle t",
        std::move(mesh), boundary);
}

Problem gear_to_disk(double edge_length) {
    Mesh mesh = polygon_mesh(gear(12, 0.78, 1), edge_length);
    BoundaryPlacement placement;
    placement.speed = BoundarySpeed::conformal;
    const auto boundary = boundary_to_disk(Surface(mesh), 0.6, placement);
    return with_boundary("gear_to_disk",
                         "A gear with 12 teeth to the disk, e^{i(t + 0.6 sin t)} of the conformal angle t",
                         std::move(mesh), boundary);
}

Problem disk_to_gear(double edge_length) {
    Mesh mesh = unit_disk(edge_length);
    std::vector<Complex> outline = to_complex(gear(12, 0.78, 1));
    // Even angles instead of the conformal speed, in which teeth shrink to a few edges: each corner of the gear is the
    // image of its own angle.
    BoundaryCondition boundary;
    const Topology shape = topology(mesh);
    for (const int v : shape.boundary_loops[0]) {
        const double t = std::arg(place(mesh, v));
        const Complex ray = std::polar(1.0, t);
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Complex a = outline[i], side = outline[(i + 1) % outline.size()] - a;
            // a + s·side on the ray
            const double along = std::imag(std::conj(ray) * side);
            const double s = along == 0 ? -1 : -std::imag(std::conj(ray) * a) / along;
            const Complex hit = a + s * side;
            if (s < -1e-12 || s >= 1 - 1e-12 || std::real(std::conj(ray) * hit) <= 0) continue;
            boundary.pin(v, hit);
            break;
        }
    }
    return with_boundary("disk_to_gear", "The disk to a gear with 12 teeth, along the rays from the centre",
                         std::move(mesh), std::move(boundary));
}

Problem wedge(double edge_length) {
    return with_homeomorphism("wedge", "The unit square to a trapezoid with sides 0.4 and 1, even speed on each side",
                              unit_square(edge_length), [](Complex z) {
                                  const double x = z.real(), y = z.imag() - 0.5;
                                  return Complex(x, y * (0.4 + 0.6 * x));
                              });
}

Problem sector(double edge_length) {
    // log f is affine with the axes x and y: K is the ratio of the two factors.
    const double radial = 1.2, around = 2.4, ratio = around / radial;
    return with_exact_map(
        "sector", "The unit square to a sector of an annulus by exp(1.2 x + 2.4 i y)", unit_square(edge_length),
        [=](Complex z) { return std::exp(Complex(radial * z.real(), around * z.imag())); }, k_of(ratio));
}

}  // namespace beltrami::bench
