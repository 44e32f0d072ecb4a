#include <beltrami/hyperbolic/hyperbolic_domain.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <tuple>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/hyperbolic/fold_opening.h>
#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/halfedges.h>

namespace beltrami {

namespace {

constexpr double kSamePlace = 1e-6;  // hyperbolic distance; others differ by a deck transformation

/// The steps along the surface's own half-edges, and where the first one begins.
struct OwnSteps {
    std::vector<DiskIsometry> steps;
    DiskIsometry first;
};

/// Frames of all corners of all triangles in the disk.
std::vector<DiskIsometry> develop(const HyperbolicSurface& surface, const OwnSteps& own_steps) {
    const IntrinsicTriangulation& triangulation = surface.original;
    const int own = 3 * surface.own_triangles();
    const std::vector<DiskIsometry>& steps = own_steps.steps;
    std::vector<DiskIsometry> frames(surface.steps.size());
    std::vector<char> placed(static_cast<std::size_t>(triangulation.triangle_count()), 0);
    using Waiting = std::tuple<double, int>;  // distance of the middle beyond a half-edge from 0
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
    const auto beyond = [&](int h) {  // the frame of the apex of the neighbour
        const int g = triangulation.twin(h);
        return (frames[h] * steps[next_halfedge(g)]).normalized();
    };
    const auto push = [&](int h) {
        if (triangulation.twin(h) >= own) return;
        const Complex sum = frames[h].place() + frames[next_halfedge(h)].place() + beyond(h).place();
        queue.emplace(std::abs(sum) / 3, h);
    };
    frames[0] = own_steps.first;
    frames[1] = own_steps.first * steps[0];
    frames[2] = own_steps.first * steps[2].inverse();
    placed[0] = 1;
    for (int k = 0; k < 3; ++k) push(k);
    while (!queue.empty()) {
        const int h = std::get<1>(queue.top()), g = triangulation.twin(h);
        queue.pop();
        if (placed[g / 3]) continue;
        placed[g / 3] = 1;
        frames[g] = frames[next_halfedge(h)];
        frames[next_halfedge(g)] = frames[h];
        frames[previous_halfedge(g)] = beyond(h);
        for (const int other : {next_halfedge(g), previous_halfedge(g)}) push(other);
    }
    return frames;
}

/// The half-edge of a triangle that begins at every corner of a face, whose quads are two triangles (#corners).
std::vector<int> halfedges_of_corners(const Surface& surface, const HyperbolicSurface& metric) {
    const FaceList& faces = surface.mesh.faces;
    std::vector<int> result(static_cast<std::size_t>(faces.corner_count()), -1);
    for (int h = 3 * metric.own_triangles() - 1; h >= 0; --h) {
        const int f = metric.metric.faces[static_cast<std::size_t>(h / 3)];
        for (int i = 0; i < faces.degree(f); ++i)
            if (faces[f][i] == metric.original.tail(h)) result[faces.first_corner(f) + i] = h;
    }
    return result;
}

/// The steps of the metric, after vertices were moved where faces had come out flipped: the identity with folds opened.
OwnSteps opened_steps(const Surface& surface, const HyperbolicSurface& metric) {
    OwnSteps result{metric.steps, {}};
    if (metric.inverted.empty() || surface.operators.sample_count() != surface.mesh.face_count()) return result;
    const Topology& topology = surface.topology;
    const std::vector<int> halfedges = halfedges_of_corners(surface, metric);
    const auto n = static_cast<std::size_t>(surface.mesh.vertex_count());
    EquivariantMap identity{std::vector<DiskIsometry>(topology.edges.size()), {}, {}, std::vector<DiskIsometry>(n)};
    const auto& vertices = surface.mesh.faces.vertices();
    for (std::size_t c = 0; c < halfedges.size(); ++c) {
        const auto edge = static_cast<std::size_t>(topology.corner_edges[c]);
        const DiskIsometry& step = metric.step(halfedges[c]);
        identity.steps[edge] = topology.edges[edge][0] == vertices[c] ? step : step.inverse();
    }
    if (open_folds(surface, identity) == 0) return result;
    for (std::size_t c = 0; c < halfedges.size(); ++c)
        result.steps[static_cast<std::size_t>(halfedges[c])] = step_at_corner(surface, identity, static_cast<int>(c));
    result.first = identity.frames[static_cast<std::size_t>(metric.original.tail(0))];
    return result;
}

TextureCoordinates layout_of(const Surface& surface, const HyperbolicSurface& metric,
                             const std::vector<DiskIsometry>& frames) {
    const IntrinsicTriangulation& triangulation = metric.original;
    DisjointSets corners(triangulation.halfedge_count());
    const auto same = [&](int a, int b) { return (frames[a].inverse() * frames[b]).distance() < kSamePlace; };
    for (int h = 0; h < 3 * metric.own_triangles(); ++h) {
        const int g = triangulation.twin(h);
        if (g < 3 * metric.own_triangles() && same(h, next_halfedge(g)) && same(next_halfedge(h), g)) {
            corners.join(h, next_halfedge(g));
            corners.join(next_halfedge(h), g);
        }
    }
    TextureCoordinates layout;
    std::map<int, int> numbers;
    for (const int h : halfedges_of_corners(surface, metric))
        layout.corners.push_back(numbers.try_emplace(corners.find(h), static_cast<int>(numbers.size())).first->second);
    layout.points.resize(static_cast<Eigen::Index>(numbers.size()), 2);
    for (const auto& [corner, number] : numbers)
        layout.points.row(number) << frames[corner].place().real(), frames[corner].place().imag();
    return layout;
}

}  // namespace

HyperbolicDomain hyperbolic_domain(const Surface& surface, const HyperbolicSurface& metric) {
    const FaceList& faces = surface.mesh.faces;
    HyperbolicDomain domain;
    const OwnSteps steps = opened_steps(surface, metric);
    domain.layout = layout_of(surface, metric, develop(metric, steps));
    Eigen::VectorXcd corners(faces.corner_count());
    for (Eigen::Index c = 0; c < corners.size(); ++c) {
        const auto point = domain.layout.points.row(domain.layout.corners[static_cast<std::size_t>(c)]);
        corners[c] = {point[0], point[1]};
    }
    domain.distortion = distortion(per_corner(surface.operators, faces), corners);

    const std::vector<double> lengths = edge_lengths(surface.topology, metric);
    const int root = faces.vertices()[0];
    const CutTree tree = metric.has_boundary() ? short_cut_tree_with_boundary(metric, lengths, root)
                                               : short_cut_tree(metric.original, lengths, root);
    domain.paths = generator_paths(metric.original, tree);
    domain.generators = generator_isometries(metric.original, tree, metric.steps);
    for (const DiskIsometry& generator : domain.generators) domain.lengths.push_back(generator.translation_length());
    domain.boundary_lengths = boundary_lengths(metric, surface.topology);
    if (metric.has_boundary()) return domain;
    DiskIsometry relation;
    for (const Letter& letter : boundary_word(metric.original, tree)) {
        const DiskIsometry& generator = domain.generators[static_cast<std::size_t>(letter.generator)];
        relation = relation * (letter.inverse ? generator.inverse() : generator);
    }
    domain.relation = relation.from_identity();
    return domain;
}

}  // namespace beltrami
