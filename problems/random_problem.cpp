#include "problems/random_problem.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/meshing/planar_domains.h>

#include "problems/construct.h"
#include "problems/feasibility.h"
#include "problems/outlines.h"

namespace beltrami::bench {

namespace {

int whole(Random& random, int low, int high) {
    return low + static_cast<int>(random.next() % static_cast<std::uint64_t>(high - low + 1));
}

double log_uniform(Random& random, double low, double high) {
    return low * std::pow(high / low, random.uniform());
}

enum class MeshKind { regular, jittered, graded, coarse, stretched, thin };
constexpr const char* mesh_kinds[] = {"regular", "jittered", "graded", "coarse", "stretched", "thin triangles"};

struct Outline {
    Polygon corners;
    const char* kind;
};

/// About the unit disk; smooth ones in pieces of about the edge length.
Outline random_outline(Random& random, double edge_length) {
    const int kind = whole(random, 0, 5);
    const int pieces = std::clamp(static_cast<int>(2 * kPi / edge_length), 16, 2000);
    Polygon result;
    if (kind == 0) return {regular(pieces, {0, 0}, 1, 0), "disk"};
    if (kind == 1) {
        const double a = random.uniform(0.5, 0.9);
        for (const auto& p : regular(pieces, {0, 0}, 1, 0)) result.push_back({p.x(), a * p.y()});
        return {result, "ellipse"};
    }
    if (kind == 2) {
        double amplitude[5], phase[5];
        for (int j = 0; j < 5; ++j) {
            amplitude[j] = random.uniform(0, 0.5) / (j + 2);
            phase[j] = random.uniform(0, 2 * kPi);
        }
        for (int i = 0; i < pieces; ++i) {
            const double t = 2 * kPi * i / pieces;
            double r = 1;
            for (int j = 0; j < 5; ++j) r += amplitude[j] * std::cos((j + 2) * t + phase[j]);
            result.push_back({r * std::cos(t), r * std::sin(t)});
        }
        return {result, "smooth outline"};
    }
    if (kind == 3) {
        const double a = random.uniform(0.6, 1.0), b = random.uniform(0.6, 1.0);
        return {{{-a, -b}, {a, -b}, {a, b}, {-a, b}}, "rectangle"};
    }
    if (kind == 4) {
        const double a = random.uniform(-0.3, 0.3), b = random.uniform(-0.3, 0.3);
        return {{{-1, -1}, {1, -1}, {1, b}, {a, b}, {a, 1}, {-1, 1}}, "L-shape"};
    }
    const int corners = whole(random, 3, 9);
    const double turn = random.uniform(0, 2 * kPi);
    for (int i = 0; i < corners; ++i) {
        const double t = turn + 2 * kPi * (i + random.uniform(-0.25, 0.25)) / corners;
        const double r = random.uniform(0.65, 1.1);
        result.push_back({r * std::cos(t), r * std::sin(t)});
    }
    return {result, "polygon"};
}

double distance_to(const Polygon& polygon, const Eigen::Vector2d& p) {
    double least = 1e300;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a;
        const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (p - a - t * d).norm());
    }
    return least;
}

bool inside(const Polygon& polygon, const Eigen::Vector2d& p) {
    bool in = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
            in = !in;
    }
    return in;
}

Polygon random_hole(Random& random, const Circle& room, double edge_length) {
    const int kind = whole(random, 0, 3);
    const double turn = random.uniform(0, 2 * kPi);
    const int pieces = std::clamp(static_cast<int>(2 * kPi * room.radius / edge_length), 6, 400);
    if (kind == 0) return regular(pieces, room.centre, room.radius, turn);
    if (kind == 1) return regular(whole(random, 3, 6), room.centre, room.radius, turn);
    // An ellipse, a slit-like one every other time.
    const double across = kind == 2 ? random.uniform(0.4, 0.9) : random.uniform(0.06, 0.15);
    const Eigen::Vector2d axis(std::cos(turn), std::sin(turn)), other(-axis.y(), axis.x());
    Polygon result;
    for (const auto& p : regular(std::max(pieces, 8), {0, 0}, room.radius, 0))
        result.push_back(room.centre + axis * p.x() + other * (across * p.y()));
    return result;
}

struct RandomDomain {
    Mesh mesh;
    std::vector<Complex> hole_centres;
    std::string description;
};

RandomDomain random_domain(Random& random) {
    const auto mesh_kind = static_cast<MeshKind>(whole(random, 0, 5));
    const double triangles =
        mesh_kind == MeshKind::coarse ? log_uniform(random, 40, 200) : log_uniform(random, 200, 4000);
    const double edge_length = std::sqrt(3.0 / (0.433 * triangles));
    Outline outline = random_outline(random, edge_length);

    // Rooms for holes that keep their distance from each other and from the outline.
    const int wanted_holes = whole(random, 0, 5);
    std::vector<Circle> rooms;
    for (int attempt = 0; attempt < 200 && static_cast<int>(rooms.size()) < wanted_holes; ++attempt) {
        const Circle room{{random.uniform(-1, 1), random.uniform(-1, 1)}, log_uniform(random, 0.06, 0.3)};
        const double gap = random.uniform(0.05, 0.15);
        bool free =
            inside(outline.corners, room.centre) && distance_to(outline.corners, room.centre) > room.radius + gap;
        for (const Circle& other : rooms)
            free = free && (other.centre - room.centre).norm() > other.radius + room.radius + gap;
        if (free) rooms.push_back(room);
    }
    RandomDomain result;
    std::vector<Polygon> holes;
    for (const Circle& room : rooms) {
        holes.push_back(random_hole(random, room, edge_length));
        result.hole_centres.push_back({room.centre.x(), room.centre.y()});
    }

    DomainOptions options;
    options.edge_length = edge_length;
    // Drawn in any case, so that the kinds of meshes share what follows.
    const double amplitude = random.uniform(0.2, 0.5), ratio = log_uniform(random, 2, 6),
                 along = random.uniform(0, kPi);
    const Eigen::Vector2d source(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    options.jitter.seed = random.next();
    Eigen::Matrix2d stretch = Eigen::Matrix2d::Identity();
    switch (mesh_kind) {
        case MeshKind::jittered:
            options.jitter.amplitude = amplitude;
            break;
        case MeshKind::graded:
            options.edge_length *= 1.5;
            options.grading = 1;
            options.sources.push_back({source, edge_length / 12});
            break;
        case MeshKind::stretched: {
            Eigen::Matrix2d turn;
            turn << std::cos(along), -std::sin(along), std::sin(along), std::cos(along);
            stretch = turn * Eigen::Vector2d(std::sqrt(ratio), 1 / std::sqrt(ratio)).asDiagonal() * turn.transpose();
            break;
        }
        case MeshKind::thin:
            options.min_angle = 0.06;
            break;
        default:
            break;
    }
    const Eigen::Matrix2d back = stretch.inverse();
    for (auto& p : outline.corners) p = back * p;
    for (auto& hole : holes)
        for (auto& p : hole) p = back * p;
    result.mesh = polygon_domain(outline.corners, holes, options);
    result.mesh.positions = result.mesh.positions * stretch.transpose();
    result.description = std::string(outline.kind) + " with " + std::to_string(holes.size()) + " holes, " +
                         mesh_kinds[static_cast<int>(mesh_kind)] + " mesh";
    return result;
}

}  // namespace

Problem random_problem(std::uint64_t seed) {
    Random random(0x5EED0000u + seed);
    RandomDomain domain = random_domain(random);
    const auto family = random_homeomorphisms(random, domain.hole_centres);
    const double bound = random.uniform(0.2, 0.95);
    const auto at_strength = [&](double strength) {
        return with_homeomorphism("random_" + std::to_string(seed), domain.description, domain.mesh, family(strength));
    };
    const auto acceptable = [&](const Problem& problem) {
        const MapQuality quality = map_quality(problem, *problem.witness);
        return quality.flipped == 0 && quality.max_mu < bound && infeasibility(problem).empty();
    };
    // The identity is acceptable, so the lower end always is.
    double low = 0, high = 2.5;
    Problem best = at_strength(0);
    for (int step = 0; step < 8; ++step) {
        const double middle = (low + high) / 2;
        Problem problem = at_strength(middle);
        if (acceptable(problem)) {
            low = middle;
            best = std::move(problem);
        } else {
            high = middle;
        }
    }
    return best;
}

}  // namespace beltrami::bench
