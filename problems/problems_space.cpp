// Problems on surfaces in space.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include <beltrami/base/constants.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/jitter.h>

#include "problems/construct.h"
#include "problems/outlines.h"

namespace beltrami::bench {

namespace {

using Lift = std::function<Eigen::Vector3d(double x, double y)>;

/// A planar mesh carried into space.
Mesh lifted(const Mesh& plane, const Lift& lift) {
    Mesh result;
    result.faces = plane.faces;
    result.positions.resize(plane.vertex_count(), 3);
    for (int v = 0; v < plane.vertex_count(); ++v)
        result.positions.row(v) = lift(plane.positions(v, 0), plane.positions(v, 1)).transpose();
    return result;
}

double smoothstep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

Problem screw(double edge_length) {
    constexpr int starts = 3;
    constexpr double spacing = 0.9, depth = 0.22, height = 3, inner = 0.45;
    // A step along the axis turns the thread by one column, so that its edges run through vertices.
    const int nu = 6 * std::max(2, static_cast<int>(std::lround(2 * kPi / edge_length / 6)));
    const double step = spacing * starts / nu;
    const int nz = static_cast<int>(std::lround(height / step));
    Mesh mesh = cylinder(1, nz * step, nu, nz);
    Problem problem;
    problem.name = "screw";
    problem.statement = "A screw with three threads to the annulus .45 < |w| < 1, both rims at even speed";
    problem.witness.emplace(mesh.vertex_count());
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j <= nz; ++j) {
            const int v = i * (nz + 1) + j;
            const double angle = 2 * kPi * i / nu, along = static_cast<double>(j) / nz;
            // Threads fade at both ends, where the rims are round.
            const int phase = ((i * starts + j * starts) % nu + nu) % nu;
            const double tooth = std::abs(2.0 * phase / nu - 1);  // 1 on the sharp edge, 0 half way to the next
            const double fade = smoothstep(0, 0.12, along) * smoothstep(0, 0.12, 1 - along);
            // The lower rim is a little wider: so it is loop 0, the outer one, on every mesh.
            const double radius = 1 + 0.01 * (1 - smoothstep(0, 0.12, along)) - depth * fade * (1 - tooth);
            mesh.positions.row(v) << radius * std::cos(angle), radius * std::sin(angle), j * step;
            // The lower rim goes outside: so the front of the surface is seen from above.
            (*problem.witness)[v] = std::polar(1 - (1 - inner) * along, angle);
        }
    for (const auto& loop : topology(mesh).boundary_loops)
        for (const int v : loop) problem.boundary.pin(v, (*problem.witness)[v]);
    for (int i = 0; i < nu; ++i) {
        if (i * starts % nu != 0) continue;
        std::vector<int> edge;
        for (int j = 0; j <= nz; ++j) edge.push_back(((i - j) % nu + nu) % nu * (nz + 1) + j);
        problem.highlights.push_back(std::move(edge));
    }
    problem.mesh = std::move(mesh);
    return problem;
}

Problem cad_part(double edge_length) {
    // Over the rectangle of (s, t): a profile in s — wall, round, plateau, chamfer — turned about an axis as t grows
    // and swelling on the way; a rib rises beyond t = 1.5 between the first two edges. Edges are lines of the grid.
    constexpr double width = 4, depth = 3;
    const int nx = 4 * std::max(2, static_cast<int>(std::lround(width / edge_length / 4))),
              ny = 4 * std::max(2, static_cast<int>(std::lround(depth / edge_length / 4)));
    Mesh plane = rectangle(width, depth, nx, ny);
    const auto at = [&](int i, int j) { return j * (nx + 1) + i; };
    struct Line {
        const char* name;
        bool along_t;
        double place, from, to;
    };
    const std::vector<Line> lines{{"wall", true, 0, 0, depth},
                                  {"wall to round", true, 1, 0, depth},
                                  {"round to plateau", true, 2, 0, depth},
                                  {"plateau to chamfer", true, 3, 0, depth},
                                  {"chamfer", true, width, 0, depth},
                                  {"near end", false, 0, 0, width},
                                  {"rib", false, 1.5, 1, 2},
                                  {"far end", false, depth, 0, width}};
    const auto chain = [&](const Line& line) {
        std::vector<int> result;
        const double step_x = width / nx, step_y = depth / ny;
        if (line.along_t) {
            const int i = static_cast<int>(std::lround(line.place / step_x));
            for (int j = 0; j <= ny; ++j) result.push_back(at(i, j));
        } else {
            const int j = static_cast<int>(std::lround(line.place / step_y));
            for (int i = static_cast<int>(std::lround(line.from / step_x)); i <= std::lround(line.to / step_x); ++i)
                result.push_back(at(i, j));
        }
        return result;
    };
    std::vector<char> keep(plane.vertex_count(), 0);
    for (const Line& line : lines)
        for (const int v : chain(line)) keep[v] = 1;
    JitterOptions jitter;
    jitter.amplitude = 0.35;
    jitter.seed = 12;
    plane = jittered(std::move(plane), jitter, {}, keep);

    Mesh mesh = lifted(plane, [](double s, double t) {
        double radius, height;
        if (s < 1) {  // a wall, leaning a little
            radius = 3.2 - 0.1 * s;
            height = s;
        } else if (s < 2) {  // a hollow round
            const double a = (s - 1) * kPi / 2;
            radius = 3.1 - 0.7 * (1 - std::cos(a));
            height = 1 + 0.7 * std::sin(a);
        } else if (s < 3) {
            radius = 2.4 - 0.8 * (s - 2);
            height = 1.7;
        } else {
            radius = 1.6 - 0.55 * (s - 3);
            height = 1.7 - 0.6 * (s - 3);
        }
        const double between = s > 1 && s < 2 ? std::sin(kPi * (s - 1)) : 0.0;
        const double rib = 0.8 * between * std::max(0.0, t - 1.5) / 1.5;
        const double angle = -0.42 * t * (1 + 0.15 * std::sin(2 * s)), swell = 1 + 0.06 * t * t / 3;
        return Eigen::Vector3d((radius + rib) * swell * std::cos(angle), (radius + rib) * swell * std::sin(angle),
                               height * (1 + 0.12 * std::sin(1.1 * t)) + 0.5 * rib);
    });

    // Values of the lines: their mean distances in space.
    const auto length_between = [&](int from, int to, bool in_s) {
        double sum = 0;
        const int across = in_s ? ny : nx;
        for (int c = 0; c <= across; ++c)
            for (int i = from; i < to; ++i) {
                const int a = in_s ? at(i, c) : at(c, i), b = in_s ? at(i + 1, c) : at(c, i + 1);
                sum += (mesh.point(a) - mesh.point(b)).norm() / (across + 1);
            }
        return sum;
    };
    std::vector<double> u{0}, v{0};
    for (int part = 0; part < 4; ++part)
        u.push_back(u.back() + length_between(part * nx / 4, (part + 1) * nx / 4, true));
    for (int half = 0; half < 2; ++half)
        v.push_back(v.back() + length_between(half * ny / 2, (half + 1) * ny / 2, false));

    Problem problem;
    problem.name = "cad_part";
    problem.statement =
        "A part with sharp edges between planar and curved faces to a rectangle: four sides and four edges on "
        "parametric lines";
    const auto u_of = [&](double s) { return u[static_cast<int>(std::lround(s))]; };
    const auto v_of = [&](double t) { return v[static_cast<int>(std::lround(2 * t / depth))]; };
    // Images run by arc length between the places where curves meet, which are corners of the lines' grid.
    std::vector<char> pinned(mesh.vertex_count(), 0);
    const Topology shape = topology(mesh);
    for (const Line& line : lines) {
        FeatureCurve curve{line.name,
                           chain(line),
                           line.along_t ? FeatureCurve::Fixed::u : FeatureCurve::Fixed::v,
                           line.along_t ? u_of(line.place) : v_of(line.place),
                           {}};
        const int count = static_cast<int>(curve.vertices.size());
        int pieces = 1;
        if (!line.along_t) pieces = static_cast<int>(std::lround(line.to - line.from));
        if (line.along_t && (line.place == 1 || line.place == 2)) pieces = 2;
        for (int piece = 0; piece < pieces; ++piece) {
            const int first = piece * (count - 1) / pieces, last = (piece + 1) * (count - 1) / pieces;
            std::vector<double> lengths{0};
            for (int i = first + 1; i <= last; ++i)
                lengths.push_back(lengths.back() +
                                  (mesh.point(curve.vertices[i]) - mesh.point(curve.vertices[i - 1])).norm());
            const double step = (line.to - line.from) / pieces, start = line.from + piece * step;
            const double from = line.along_t ? v_of(start) : u_of(start),
                         to = line.along_t ? v_of(start + step) : u_of(start + step);
            for (int i = piece == 0 ? first : first + 1; i <= last; ++i) {
                const double free = from + (to - from) * (lengths[i - first] / lengths.back());
                curve.images.push_back(line.along_t ? Complex(curve.value, free) : Complex(free, curve.value));
            }
        }
        for (int i = 0; i < count; ++i) {
            const int vertex = curve.vertices[i];
            if (!shape.on_boundary[vertex] || pinned[vertex]) continue;
            problem.boundary.pin(vertex, curve.images[i]);
            pinned[vertex] = 1;
        }
        problem.features.push_back(std::move(curve));
    }
    problem.mesh = std::move(mesh);
    return problem;
}

Problem curved_plate(double edge_length) {
    const Polygon outer{{0, 0}, {6, 0}, {6, 4}, {0, 4}};
    std::vector<Polygon> holes;
    std::vector<PlaneMap> turns;
    const double angles[] = {0.5, -0.3, 0.7, -0.6, 0.2, -0.45};
    for (int i = 0; i < 6; ++i) {
        const Complex centre(1.1 + 1.9 * (i % 3), 1.1 + 1.8 * (i / 3));
        holes.push_back(regular(4, point(centre), 0.5, kPi / 4 + angles[i]));
        turns.push_back(rigid_turn(centre, -angles[i], 0.5, 0.88));
    }
    DomainOptions options;
    options.edge_length = edge_length;
    const Mesh plane = polygon_domain(outer, holes, options);
    Problem problem = with_homeomorphism("curved_plate",
                                         "A curved plate with six square openings, each turned: the rim to a "
                                         "rectangle, the openings to axis-parallel squares",
                                         plane, composition(turns));
    problem.mesh = lifted(plane, [](double x, double y) {
        return Eigen::Vector3d(x, y, 0.55 * std::sin(1.2 * x) * std::cos(1.1 * y) + 0.25 * std::sin(0.7 * x + 2 * y));
    });
    return problem;
}

Problem pierced_ball(double edge_length) {
    // An edge of the icosahedron is 1.107 long on the sphere and is split into 2^levels.
    const int levels = std::clamp(static_cast<int>(std::lround(std::log2(1.107 / edge_length))), 3, 8);
    const int reach = (1 << levels) / 4;  // rings of faces that a hole takes away
    const Mesh sphere = icosahedral_sphere(levels);
    // Combinatorial distance to the nearest of the twelve vertices of degree 5.
    std::vector<std::vector<int>> neighbours(sphere.vertex_count());
    for (int f = 0; f < sphere.face_count(); ++f) {
        const auto v = sphere.faces[f];
        for (int j = 0; j < 3; ++j) neighbours[v[j]].push_back(v[(j + 1) % 3]);
    }
    std::vector<int> distance(sphere.vertex_count(), -1), queue;
    for (int v = 0; v < 12; ++v) {
        distance[v] = 0;
        queue.push_back(v);
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (const int w : neighbours[queue[i]])
            if (distance[w] < 0) {
                distance[w] = distance[queue[i]] + 1;
                queue.push_back(w);
            }
    std::vector<int> kept;
    for (int f = 0; f < sphere.face_count(); ++f) {
        const auto v = sphere.faces[f];
        if (distance[v[0]] >= reach && distance[v[1]] >= reach && distance[v[2]] >= reach) kept.push_back(f);
    }
    Mesh mesh = keep_faces(sphere, kept).mesh;
    const Topology shape = topology(mesh);

    // Seen from outside, with the outer pentagon at the far end: stereographic from its centre.
    const auto centre_of = [&](const std::vector<int>& loop) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const int v : loop) sum += mesh.point(v);
        return Eigen::Vector3d(sum.normalized());
    };
    const Eigen::Vector3d pole = centre_of(shape.boundary_loops[0]);
    const Eigen::Vector3d first = mesh.point(shape.boundary_loops[0][0]);
    const Eigen::Vector3d x = (first - first.dot(pole) * pole).normalized(), y = -pole.cross(x);
    const auto project = [&](const Eigen::Vector3d& p) {
        return Complex(p.dot(x), p.dot(y)) / (1 - p.dot(pole) + 1e-300);
    };
    Problem problem;
    problem.name = "pierced_ball";
    problem.statement =
        "A ball with twelve pentagonal holes to the unit disk with eleven round holes of radius .12; one pentagon goes "
        "to the outer circle, all at even speed";
    for (std::size_t l = 0; l < shape.boundary_loops.size(); ++l) {
        const auto& loop = shape.boundary_loops[l];
        const double length = shape.loop_lengths[l];
        // Rings of one, five and five holes; the circles are alike, unlike those of the conformal map.
        Complex centre = 0;
        double radius = 1;
        if (l > 0) {
            const Complex seen = project(centre_of(loop));
            const double height = centre_of(loop).dot(pole);
            radius = 0.12;
            centre = height < -0.9 ? 0.0 : std::polar(height < 0 ? 0.4 : 0.74, std::arg(seen));
        }
        const Complex middle = l == 0 ? Complex(0) : project(centre_of(loop));
        const double start = std::arg(project(mesh.point(loop[0])) - middle);
        double run = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const double angle = start + (l == 0 ? 1 : -1) * 2 * kPi * run / length;
            problem.boundary.pin(loop[i], centre + std::polar(radius, angle));
            run += (mesh.point(loop[(i + 1) % loop.size()]) - mesh.point(loop[i])).norm();
        }
    }
    problem.mesh = std::move(mesh);
    return problem;
}

}  // namespace beltrami::bench
