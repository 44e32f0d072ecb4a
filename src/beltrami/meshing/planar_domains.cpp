#include <beltrami/meshing/planar_domains.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {
namespace {

double positive_or(double value, double otherwise) {
    return value > 0.0 ? value : otherwise;
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

/// The part of the size that circles and polygons share.
double common_size(const DomainOptions& options, const Eigen::Vector2d& p) {
    double size = options.edge_length;
    for (const SizeSource& source : options.sources) {
        size = std::min(size, source.edge_length + options.grading * (p - source.point).norm());
    }
    return options.size ? std::min(size, options.size(p)) : size;
}

TriangulateOptions triangulate_options(const DomainOptions& options, SizeField size) {
    TriangulateOptions result;
    result.size = std::move(size);
    result.min_angle = options.min_angle;
    result.split_ears = options.split_ears;
    result.smoothing_passes = options.smoothing_passes;
    return result;
}

Eigen::Vector2d at_angle(const Circle& circle, double angle) {
    return circle.centre + circle.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d onto_circle(const Circle& circle, const Eigen::Vector2d& p) {
    return circle.centre + circle.radius * (p - circle.centre).normalized();
}

/// Refuses at once what refinement would refuse after gigabytes.
void require_feasible(double area, const DomainOptions& options) {
    const double triangles = area / (std::sqrt(3.0) / 4.0 * options.edge_length * options.edge_length);
    if (triangles < 4e7) return;
    throw Error(Cause::bad_option,
                "edges of length " + std::to_string(options.edge_length) + " would make " + std::to_string(triangles) +
                    " triangles",
                "give a larger edge_length (the limit is 40 million triangles)");
}

void require_separate(const Circle& outer, const std::vector<Circle>& holes) {
    if (!(outer.radius > 0.0) || !std::isfinite(outer.radius) || !outer.centre.allFinite()) {
        throw Error(Cause::bad_option, "the outer circle has no finite centre and positive radius");
    }
    for (std::size_t i = 0; i < holes.size(); ++i) {
        const int index = static_cast<int>(i);
        if (!(holes[i].radius > 0.0)) {
            throw Error(Cause::bad_option, "hole " + std::to_string(i) + " has no positive radius", "",
                        {Things::curves, {index}});
        }
        if (!((holes[i].centre - outer.centre).norm() + holes[i].radius < outer.radius)) {
            throw Error(Cause::bad_option, "hole " + std::to_string(i) + " touches or leaves the outer circle",
                        "move it inwards or make it smaller", {Things::curves, {index}});
        }
        for (std::size_t j = 0; j < i; ++j) {
            if ((holes[i].centre - holes[j].centre).norm() > holes[i].radius + holes[j].radius) continue;
            throw Error(Cause::bad_option, "holes " + std::to_string(j) + " and " + std::to_string(i) + " touch",
                        "move them apart", {Things::curves, {static_cast<int>(j), index}});
        }
    }
}

/// Adds a closed chain through the given corners, sides cut to size; every side is a curve of its own.
void add_sides(PlanarDomain& domain, int first_corner, int corner_count, const SizeField& size) {
    for (int i = 0; i < corner_count; ++i) {
        const int a = first_corner + i, b = first_corner + (i + 1) % corner_count;
        const Eigen::Vector2d pa = domain.points[a], pb = domain.points[b];
        const int curve = domain.curves.empty() ? 0 : domain.curves.back() + 1;
        const std::vector<double> t = spread((pb - pa).norm(), [&](double s) { return size(pa + s * (pb - pa)); });
        int last = a;
        for (std::size_t k = 1; k + 1 < t.size(); ++k) {
            domain.points.push_back(pa + t[k] * (pb - pa));
            const int here = static_cast<int>(domain.points.size()) - 1;
            domain.segments.push_back({last, here});
            domain.curves.push_back(curve);
            last = here;
        }
        domain.segments.push_back({last, b});
        domain.curves.push_back(curve);
    }
}

double enclosed_area(const Polygon& polygon) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const Eigen::Vector2d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
        sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return std::abs(sum);
}

bool encloses(const Polygon& polygon, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
            inside = !inside;
        }
    }
    return inside;
}

/// Jitter must not move the points that were asked for.
Mesh jittered_but_keeping(const Mesh& mesh, const DomainOptions& options, int first, int count,
                          const std::function<Eigen::Vector2d(int, const Eigen::Vector2d&)>& project) {
    if (options.jitter.amplitude == 0.0) return mesh;
    std::vector<char> keep(mesh.vertex_count(), 0);
    std::fill_n(keep.begin() + first, count, 1);
    return jittered(mesh, options.jitter, project, keep);
}

}  // namespace

void DomainOptions::validate() const {
    const auto require = [](bool good, const char* name, double value, const char* wanted) {
        if (!good) throw Error(Cause::bad_option, std::string(name) + " is " + std::to_string(value), wanted);
    };
    require(edge_length > 0.0 && std::isfinite(edge_length), "edge_length", edge_length, "give a positive length");
    require(hole_edge_length >= 0.0, "hole_edge_length", hole_edge_length,
            "give a positive length, or 0 for edge_length");
    require(corner_edge_length >= 0.0, "corner_edge_length", corner_edge_length,
            "give a positive length, or 0 for edge_length");
    require(grading > 0.0 && grading <= 1.0, "grading", grading, "give a value above 0 and at most 1");
    require(least_hole_edges >= 6, "least_hole_edges", least_hole_edges, "give at least 6");
    for (const SizeSource& source : sources) {
        require(source.edge_length > 0.0, "the edge length of a source", source.edge_length, "give a positive length");
    }
    jitter.validate();
}

Mesh circle_domain(const Circle& outer, const std::vector<Circle>& holes, const DomainOptions& options) {
    options.validate();
    require_separate(outer, holes);
    require_feasible(std::numbers::pi * outer.radius * outer.radius, options);
    const SizeField size = [&](const Eigen::Vector2d& p) {
        double wanted = common_size(options, p);
        for (const Circle& hole : holes) {
            const double at_hole = std::min(positive_or(options.hole_edge_length, options.edge_length),
                                            2.0 * std::numbers::pi * hole.radius / options.least_hole_edges);
            wanted =
                std::min(wanted, at_hole + options.grading * std::max(0.0, (p - hole.centre).norm() - hole.radius));
        }
        return wanted;
    };
    std::vector<Circle> circles{outer};
    circles.insert(circles.end(), holes.begin(), holes.end());
    PlanarDomain domain;
    domain.points = options.interior_points;
    domain.project = [&](int curve, const Eigen::Vector2d& p) { return onto_circle(circles[curve], p); };
    for (std::size_t c = 0; c < circles.size(); ++c) {
        const double turn = 2.0 * std::numbers::pi;
        const std::vector<double> t = spread(
            turn * circles[c].radius, [&](double s) { return size(at_angle(circles[c], turn * s)); },
            std::max(6, c > 0 ? options.least_hole_edges : 0));
        const int first = static_cast<int>(domain.points.size()), n = static_cast<int>(t.size()) - 1;
        for (int k = 0; k < n; ++k) {
            domain.points.push_back(at_angle(circles[c], turn * t[k]));
            domain.segments.push_back({first + k, first + (k + 1) % n});
            domain.curves.push_back(static_cast<int>(c));
        }
    }
    const Mesh mesh = triangulate(domain, triangulate_options(options, size));
    const auto project = [&](int vertex, const Eigen::Vector2d& p) {
        const Eigen::Vector2d old = mesh.positions.row(vertex).transpose();
        const auto distance = [&](const Circle& c) { return std::abs((old - c.centre).norm() - c.radius); };
        return onto_circle(
            *std::min_element(circles.begin(), circles.end(),
                              [&](const Circle& a, const Circle& b) { return distance(a) < distance(b); }),
            p);
    };
    return jittered_but_keeping(mesh, options, 0, static_cast<int>(options.interior_points.size()), project);
}

Mesh polygon_domain(const Polygon& outer, const std::vector<Polygon>& holes, const DomainOptions& options) {
    options.validate();
    std::vector<Polygon> loops{outer};
    loops.insert(loops.end(), holes.begin(), holes.end());
    PlanarDomain domain;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const int index = static_cast<int>(i) - 1;
        if (loops[i].size() < 3) {
            throw Error(Cause::bad_option, i == 0 ? "the outer polygon has fewer than 3 corners"
                                                  : "hole " + std::to_string(index) + " has fewer than 3 corners");
        }
        if (!std::all_of(loops[i].begin(), loops[i].end(), [](const Eigen::Vector2d& p) { return p.allFinite(); })) {
            throw Error(Cause::bad_option, i == 0
                                               ? "the outer polygon has a corner that is not finite"
                                               : "hole " + std::to_string(index) + " has a corner that is not finite");
        }
        if (i > 0 && !encloses(outer, loops[i][0])) {
            throw Error(Cause::bad_option, "hole " + std::to_string(index) + " lies outside the outer polygon",
                        "move it inside", {Things::curves, {index}});
        }
        for (std::size_t j = 1; i > 0 && j < loops.size(); ++j) {
            if (j == i || !encloses(loops[j], loops[i][0])) continue;
            throw Error(Cause::bad_option, "hole " + std::to_string(index) + " lies in hole " + std::to_string(j - 1),
                        "give separate holes", {Things::curves, {index, static_cast<int>(j) - 1}});
        }
        domain.points.insert(domain.points.end(), loops[i].begin(), loops[i].end());
    }
    require_feasible(enclosed_area(outer), options);
    const std::vector<Eigen::Vector2d> corners = domain.points;
    const SizeField size = [&](const Eigen::Vector2d& p) {
        double wanted = common_size(options, p);
        if (options.corner_edge_length > 0.0) {
            for (const Eigen::Vector2d& c : corners) {
                wanted = std::min(wanted, options.corner_edge_length + options.grading * (p - c).norm());
            }
        }
        if (options.hole_edge_length > 0.0) {
            for (const Polygon& hole : holes) {
                for (std::size_t k = 0; k < hole.size(); ++k) {
                    const double distance = distance_to_segment(p, hole[k], hole[(k + 1) % hole.size()]);
                    wanted = std::min(wanted, options.hole_edge_length + options.grading * distance);
                }
            }
        }
        return wanted;
    };
    domain.points.insert(domain.points.end(), options.interior_points.begin(), options.interior_points.end());
    int first = 0;
    for (const Polygon& loop : loops) {
        add_sides(domain, first, static_cast<int>(loop.size()), size);
        first += static_cast<int>(loop.size());
    }
    const Mesh mesh = triangulate(domain, triangulate_options(options, size));
    return jittered_but_keeping(mesh, options, first, static_cast<int>(options.interior_points.size()), {});
}

}  // namespace beltrami
