#include <beltrami/generate/round_domains.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>

namespace beltrami {
namespace {

constexpr int most_rings = 7000;  // 294 million triangles, near what int indices can hold

}  // namespace

Mesh disk(int rings, double radius, const JitterOptions& jitter) {
    if (rings < 1 || rings > most_rings || !(radius > 0.0) || !std::isfinite(radius)) {
        throw Error(
            Cause::bad_option,
            "a disk of radius " + std::to_string(radius) + " with " + std::to_string(rings) + " rings is impossible",
            "give 1 to 7000 rings and a positive radius");
    }
    const auto first_of = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
    Mesh mesh;
    mesh.positions.resize(first_of(rings + 1), 2);
    mesh.positions.row(0).setZero();
    for (int ring = 1; ring <= rings; ++ring) {
        const double r = ring == rings ? radius : radius * ring / rings;
        for (int i = 0; i < 6 * ring; ++i) {
            const double angle = kTurn * i / (6 * ring);
            mesh.positions.row(first_of(ring) + i) << r * std::cos(angle), r * std::sin(angle);
        }
    }
    mesh.faces.reserve(6 * rings * rings, 18 * rings * rings);
    const auto vertex = [&](int ring, int i) { return ring == 0 ? 0 : first_of(ring) + (i == 6 * ring ? 0 : i); };
    for (int ring = 1; ring <= rings; ++ring) {
        for (int sector = 0; sector < 6; ++sector) {
            const int outer = sector * ring, inner = sector * (ring - 1);
            for (int j = 0; j < ring; ++j) {
                mesh.faces.add({vertex(ring - 1, inner + j), vertex(ring, outer + j), vertex(ring, outer + j + 1)});
                if (j + 1 == ring) break;
                mesh.faces.add(
                    {vertex(ring - 1, inner + j), vertex(ring, outer + j + 1), vertex(ring - 1, inner + j + 1)});
            }
        }
    }
    return jittered(std::move(mesh), jitter,
                    [&](int, const Eigen::Vector2d& p) { return (radius * p.normalized()).eval(); });
}

int disk_rings_for_edge_length(double edge_length, double radius) {
    if (!(edge_length > 0.0) || !(radius > 0.0)) {
        throw Error(Cause::bad_option, "the edge length or the radius of a disk is not positive");
    }
    return static_cast<int>(std::clamp(std::round(radius / edge_length), 1.0, double(most_rings)));
}

int disk_rings_for_triangles(double triangles) {
    return static_cast<int>(std::clamp(std::round(std::sqrt(std::max(triangles, 1.0) / 6.0)), 1.0, double(most_rings)));
}

Mesh annulus(double inner, double outer, int around, int layers, const JitterOptions& jitter) {
    if (!(inner > 0.0) || !(inner < outer) || !std::isfinite(outer) || around < 3 || layers < 0) {
        throw Error(Cause::bad_option,
                    "an annulus from " + std::to_string(inner) + " to " + std::to_string(outer) + " with " +
                        std::to_string(around) + " vertices around is impossible",
                    "give 0 < inner < outer and at least 3 vertices");
    }
    const double height = std::log(outer / inner);
    if (layers == 0)
        layers = std::max(2, static_cast<int>(std::lround(height / (kTurn / around * std::sqrt(3.0) / 2.0))));
    if (1.0 * around * (layers + 1.0) > 1e8) {
        throw Error(Cause::bad_option, "the annulus would have more than 100 million vertices", "give fewer");
    }
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(around) * (layers + 1), 2);
    for (int ring = 0; ring <= layers; ++ring) {
        const double r = ring == layers ? outer : inner * std::exp(height * ring / layers);
        for (int i = 0; i < around; ++i) {
            const double angle = kTurn * (i + 0.5 * (ring % 2)) / around;
            mesh.positions.row(ring * around + i) << r * std::cos(angle), r * std::sin(angle);
        }
    }
    mesh.faces.reserve(2 * around * layers, 6 * around * layers);
    for (int ring = 0; ring < layers; ++ring) {
        const auto in = [&](int i) { return ring * around + i % around; };
        const auto out = [&](int i) { return (ring + 1) * around + (i + ring % 2) % around; };
        for (int i = 0; i < around; ++i) {
            mesh.faces.add({in(i), out(i), in(i + 1)});
            mesh.faces.add({in(i + 1), out(i), out(i + 1)});
        }
    }
    return jittered(std::move(mesh), jitter, [&](int vertex, const Eigen::Vector2d& p) {
        return ((vertex < around ? inner : outer) * p.normalized()).eval();
    });
}

}  // namespace beltrami
