#include <beltrami/hyperbolic/hyperbolic_domain.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <tuple>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/halfedges.h>

namespace beltrami {

namespace {

constexpr double kSamePlace = 1e-6;  // hyperbolic distance; others differ by a deck transformation

/// Frames of all corners of all triangles in the disk.
std::vector<DiskIsometry> develop(const HyperbolicSurface& surface) {
    const IntrinsicTriangulation& triangulation = surface.original;
    const int own = 3 * surface.own_triangles();
    std::vector<DiskIsometry> frames(surface.steps.size());
    std::vector<char> placed(static_cast<std::size_t>(triangulation.triangle_count()), 0);
    using Waiting = std::tuple<double, int>;  // distance of the middle beyond a half-edge from 0
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
    const auto beyond = [&](int h) {  // the frame of the apex of the neighbour
        const int g = triangulation.twin(h);
        return (frames[h] * surface.step(next_halfedge(g))).normalized();
    };
    const auto push = [&](int h) {
        if (triangulation.twin(h) >= own) return;
        const Complex sum = frames[h].place() + frames[next_halfedge(h)].place() + beyond(h).place();
        queue.emplace(std::abs(sum) / 3, h);
    };
    frames[1] = surface.step(0);
    frames[2] = surface.step(2).inverse();
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
    domain.layout = layout_of(surface, metric, develop(metric));
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
