#include <beltrami/homotopy/twist.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/inside_polygon.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/solve/composition.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

void require_turns_per_loop(const Surface& source, const std::vector<int>& turns) {
    const std::size_t loops = source.topology.boundary_loops.size();
    if (turns.size() != loops)
        throw Error(Cause::bad_option,
                    "turns are given for " + std::to_string(turns.size()) + " boundary loops, the mesh has " +
                        std::to_string(loops),
                    "give one number per loop, 0 for the outer one");
}

/// The places as a mesh of the plane.
Mesh planar_mesh(const Surface& source, const Eigen::VectorXcd& positions) {
    Mesh mesh;
    mesh.faces = source.mesh.faces;
    mesh.positions.resize(positions.size(), 2);
    mesh.positions << positions.real(), positions.imag();
    return mesh;
}

/// Continuous branch of log((f − c)/(z − z_c)) along a loop, from a given branch of the first vertex' argument.
std::vector<Complex> logarithms(const std::vector<int>& loop, const Eigen::VectorXcd& z, Complex z_centre,
                                const Eigen::VectorXcd& f, Complex centre, double first_argument) {
    const auto ratio = [&](int v) { return (f[v] - centre) / (z[v] - z_centre); };
    std::vector<Complex> result;
    double argument = first_argument;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (i > 0) {  // differences of image and source each below π, where that of the ratio need not be
            const int a = loop[i - 1], b = loop[i];
            argument += std::arg((f[b] - centre) / (f[a] - centre)) - std::arg((z[b] - z_centre) / (z[a] - z_centre));
        }
        result.emplace_back(std::log(std::abs(ratio(loop[i]))), argument);
    }
    return result;
}

}  // namespace

HoleRing hole_ring(const Surface& source, const Eigen::VectorXcd& positions, int loop) {
    const auto& loops = source.topology.boundary_loops;
    HoleRing ring;
    ring.loop = loop;
    ring.centre = point_inside(loop_images(loops[loop], positions));
    ring.outer = std::numeric_limits<double>::infinity();
    for (int l = 0; l < static_cast<int>(loops.size()); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const Complex a = positions[loops[l][i]] - ring.centre,
                          b = positions[loops[l][(i + 1) % loops[l].size()]] - ring.centre;
            if (l == loop) {
                ring.inner = std::max(ring.inner, std::abs(a));
                continue;
            }
            const double square = std::norm(b - a);
            const double t = square > 0 ? std::clamp(-std::real(std::conj(b - a) * a) / square, 0.0, 1.0) : 0.0;
            ring.outer = std::min(ring.outer, std::abs(a + t * (b - a)));
        }
    return ring;
}

Eigen::VectorXcd twisted_map(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                             const Eigen::VectorXcd& map, const std::vector<int>& extra_turns) {
    require_turns_per_loop(source, extra_turns);
    struct Twist {
        HoleRing ring;
        int turns;
    };
    std::vector<Twist> twists;
    for (int l = 0; l < static_cast<int>(extra_turns.size()); ++l) {
        if (l == outer_loop || extra_turns[l] == 0) continue;
        const HoleRing ring = hole_ring(source, positions, l);
        if (!(ring.inner < ring.outer))
            throw Error(Cause::bad_mesh,
                        "no round ring around boundary loop " + std::to_string(l) +
                            " is free of the other loops, so it cannot be turned",
                        "give places in a domain whose holes are round", {Things::loops, {l}});
        twists.push_back({ring, extra_turns[l]});
    }
    std::vector<int> moved;
    std::vector<Complex> places;
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        if (source.topology.on_boundary[v]) continue;
        Complex z = positions[v];
        bool moves = false;
        for (const Twist& twist : twists) {
            const HoleRing& ring = twist.ring;
            const double distance = std::abs(z - ring.centre);
            if (!(distance > ring.inner && distance < ring.outer)) continue;
            const double share = std::log(ring.outer / distance) / std::log(ring.outer / ring.inner);
            z = ring.centre + (z - ring.centre) * std::polar(1.0, kTurn * twist.turns * share);
            moves = true;
        }
        if (!moves) continue;
        moved.push_back(v);
        places.push_back(z);
    }
    Eigen::VectorXcd result = map;
    if (moved.empty()) return result;
    // Places that a twist brings close to a polygonal boundary may lie just outside it: the nearest point is taken.
    const Eigen::VectorXcd values =
        compose_maps(Eigen::Map<const Eigen::VectorXcd>(places.data(), static_cast<Eigen::Index>(places.size())),
                     planar_mesh(source, positions), map, 0.05);
    for (std::size_t i = 0; i < moved.size(); ++i) result[moved[i]] = values[static_cast<Eigen::Index>(i)];

    const std::vector<LoopPath> paths = loop_paths(source, positions, outer_loop);
    const HomotopyClass before = homotopy_class(source, paths, map, outer_loop),
                        after = homotopy_class(source, paths, result, outer_loop);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const int wanted = before.holes[i].turns + extra_turns[paths[i].loop];
        if (before.holes[i].meaningful && after.holes[i].turns != wanted)
            throw Error(Cause::not_solved,
                        "the mesh is too coarse around boundary loop " + std::to_string(paths[i].loop) + ": of " +
                            std::to_string(wanted) + " turns it holds " + std::to_string(after.holes[i].turns),
                        "refine the mesh there, at least eight layers of faces a turn",
                        {Things::loops, {paths[i].loop}});
    }
    return result;
}

Eigen::VectorXcd logarithmic_map(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                                 const BoundaryCondition& boundary, int turns) {
    if (source.topology.boundary_loops.size() != 2 || source.topology.genus != 0)
        throw Error(
            Cause::bad_mesh,
            "a map harmonic in the logarithm needs a surface of genus 0 with two boundary loops, this one has " +
                std::to_string(source.topology.boundary_loops.size()),
            "twist the harmonic map instead");
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    const LoopPath path = loop_paths(source, positions, outer_loop)[0];
    const std::vector<int>&outer = source.topology.boundary_loops[outer_loop],
          &hole = source.topology.boundary_loops[path.loop];
    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    const Complex z_centre = point_inside(loop_images(hole, positions)),
                  centre = point_inside(loop_images(hole, images));
    for (const int l : {outer_loop, path.loop}) {
        const auto& loop = source.topology.boundary_loops[l];
        const int around = winding_number(loop_images(loop, images), centre),
                  source_around = winding_number(loop_images(loop, positions), z_centre);
        if (around != source_around || around == 0)
            throw Error(Cause::bad_boundary,
                        "the image of boundary loop " + std::to_string(l) + " runs " + std::to_string(around) +
                            " times around a point inside the image of the hole, the loop itself " +
                            std::to_string(source_around) + " times around the hole",
                        "the hole's image must lie inside the outer one's, both in the source's direction",
                        {Things::loops, {l}});
    }
    const int from = path.vertices.front(), to = path.vertices.back();
    const double wanted = smallest_angle(images[from], images[to], centre) + kTurn * turns,
                 own = turning_angle(loop_images(path.vertices, positions), z_centre);

    // H of the outer loop from its first vertex on; that of the hole follows from the angle wanted along the path.
    const auto at = [](const std::vector<int>& loop, int v) {
        return std::find(loop.begin(), loop.end(), v) - loop.begin();
    };
    const std::vector<Complex> H_outer =
        logarithms(outer, positions, z_centre, images, centre,
                   std::arg((images[outer[0]] - centre) / (positions[outer[0]] - z_centre)));
    std::vector<Complex> H_hole = logarithms(hole, positions, z_centre, images, centre, 0.0);
    const double shift = H_outer[at(outer, from)].imag() + wanted - own - H_hole[at(hole, to)].imag();
    BoundaryCondition values;
    for (std::size_t i = 0; i < outer.size(); ++i) values.pin(outer[i], H_outer[i]);
    for (std::size_t i = 0; i < hole.size(); ++i) values.pin(hole[i], H_hole[i] + Complex(0, shift));
    // Vertices that boundary prescribes inside are left to the solver that starts from here.
    const Eigen::VectorXcd H = harmonic_map(source, values);
    Eigen::VectorXcd map(H.size());
    for (Eigen::Index v = 0; v < H.size(); ++v) map[v] = centre + (positions[v] - z_centre) * std::exp(H[v]);
    for (const std::vector<int>* loop : {&outer, &hole})
        for (const int v : *loop) map[v] = images[v];
    return map;
}

StartInClass start_in_class(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                            const BoundaryCondition& boundary, const std::vector<int>& turns) {
    const std::vector<int> wanted = turns.empty() ? std::vector<int>(source.topology.boundary_loops.size(), 0) : turns;
    require_turns_per_loop(source, wanted);
    const std::vector<LoopPath> paths = loop_paths(source, positions, outer_loop);
    StartInClass result;
    const auto has_wanted = [&] {
        result.homotopy = homotopy_class(source, paths, result.map, outer_loop);
        return std::all_of(result.homotopy.holes.begin(), result.homotopy.holes.end(),
                           [&](const HoleTurns& hole) { return hole.meaningful && hole.turns == wanted[hole.loop]; });
    };
    const auto meaningful = [&] {
        return std::all_of(result.homotopy.holes.begin(), result.homotopy.holes.end(),
                           [](const HoleTurns& hole) { return hole.meaningful; });
    };
    result.map = harmonic_map(source, boundary);
    const std::size_t folds = distortion(source.operators, result.map).flipped.size();
    if (paths.size() == 1) {
        const bool harmonic_fits = has_wanted();
        Eigen::VectorXcd logarithmic = logarithmic_map(source, positions, outer_loop, boundary, wanted[paths[0].loop]);
        if (harmonic_fits && distortion(source.operators, logarithmic).flipped.size() > folds) return result;
        result.map = std::move(logarithmic);
        result.homotopy = homotopy_class(source, paths, result.map, outer_loop);
        return result;
    }
    if (has_wanted()) return result;
    if (!meaningful()) {
        result.repaired = static_cast<int>(folds);
        const FoldFreeMap opened =
            fold_free_map(source, freedoms(boundary, source), Eigen::VectorXcd::Zero(source.operators.sample_count()),
                          result.map, {});
        result.map = opened.map;
        if (has_wanted()) return result;
        if (!meaningful())
            throw Error(
                Cause::not_solved,
                "the harmonic map is folded between the loops and the folds do not open, so its turns cannot be "
                "read",
                "reach the boundary values in several steps (waypoints)");
    }
    std::vector<int> extra = wanted;
    for (const HoleTurns& hole : result.homotopy.holes) extra[hole.loop] -= hole.turns;
    result.map = twisted_map(source, positions, outer_loop, result.map, extra);
    result.homotopy = homotopy_class(source, paths, result.map, outer_loop);
    return result;
}

}  // namespace beltrami
