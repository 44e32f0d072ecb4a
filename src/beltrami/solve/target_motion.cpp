#include <beltrami/solve/target_motion.h>

#include <beltrami/base/parallel.h>
#include <beltrami/mesh/edge_table.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr int kGrain = 256;

std::vector<signed char> unknowns_of(const Surface& source, const TargetConstraints& constraints) {
    std::vector<signed char> unknowns(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : source.mesh.faces.vertices()) unknowns[v] = 2;
    for (const int v : constraints.fixed) unknowns[v] = 0;
    for (const TargetConstraints::Slide& slide : constraints.sliding)
        if (unknowns[slide.vertex] > 0) unknowns[slide.vertex] = 1;
    return unknowns;
}

std::vector<char> not_free(const std::vector<signed char>& unknowns) {
    std::vector<char> held;
    held.reserve(unknowns.size());
    for (const signed char count : unknowns) held.push_back(count < 2);
    return held;
}

}  // namespace

TargetMotion::TargetMotion(const Surface& source, const Target& target, const TargetConstraints& constraints)
    : target_(target),
      constraints_(constraints),
      unknowns_(unknowns_of(source, constraints)),
      slide_(unknowns_.size(), -1) {
    for (std::size_t i = 0; i < constraints.sliding.size(); ++i)
        slide_[constraints.sliding[i].vertex] = static_cast<int>(i);
    if (!constraints.sliding.empty()) inward_ = graph_of(source, not_free(unknowns_));
}

std::vector<int> TargetMotion::indices_of_moving() const {
    std::vector<int> indices(unknowns_.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < unknowns_.size(); ++v)
        if (unknowns_[v] > 0) indices[v] = count++;
    return indices;
}

TargetMotion::Directions TargetMotion::directions(int vertex, const TargetMap& map,
                                                  const Eigen::Vector3d& across) const {
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    if (unknowns_[vertex] == 0) return {none, none};
    if (const int i = slide_[vertex]; i >= 0)
        return {constraints_.curves[constraints_.sliding[i].curve]->tangent(map.parameters[i]), none};
    const TangentFrame frame(across);
    return {frame.first, frame.second};
}

TargetMap TargetMotion::moved(const TargetMap& map, const Positions& motion, double length) const {
    TargetMap result = map;
    Positions bends = Positions::Zero(inward_ ? motion.rows() : 0, 3);
    for (std::size_t i = 0; i < constraints_.sliding.size(); ++i) {
        const auto& [v, c] = constraints_.sliding[i];
        if (unknowns_[v] == 0) continue;
        const SlideCurve& curve = *constraints_.curves[c];
        const Eigen::Vector3d along = length * motion.row(v).transpose();
        result.parameters[i] = curve.wrap(map.parameters[i] + along.dot(curve.tangent(map.parameters[i])));
        result.points[v] = target_.retract(curve.point(result.parameters[i]), map.points[v]);
        bends.row(v) = result.points[v].position - map.points[v].position - along;
    }
    if (inward_) bends = extended(*inward_, bends);
    parallel_for(
        0, static_cast<int>(motion.rows()),
        [&](int first, int last) {
            for (int v = first; v < last; ++v) {
                if (unknowns_[v] != 2) continue;
                Eigen::Vector3d there = map.points[v].position + length * motion.row(v).transpose();
                if (inward_) there += bends.row(v).transpose();
                result.points[v] = target_.retract(there, map.points[v]);
            }
        },
        kGrain);
    return result;
}

std::unique_ptr<GraphLaplacian> graph_of(const Surface& source, const std::vector<char>& held) {
    std::vector<std::array<int, 2>> edges;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const auto face = source.mesh.faces[f];
        for (std::size_t i = 0; i < face.size(); ++i) edges.push_back({face[i], face[(i + 1) % face.size()]});
    }
    const std::vector<double> weights(edges.size(), 1.0);
    auto graph = std::make_unique<GraphLaplacian>(std::move(edges), held);
    graph->set(weights);
    graph->factorize();
    return graph;
}

Positions extended(const GraphLaplacian& graph, const Positions& values) {
    Eigen::VectorXcd plane(values.rows()), height(values.rows());
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
        plane[v] = {values(v, 0), values(v, 1)};
        height[v] = values(v, 2);
    }
    plane = graph.extend(std::move(plane));
    height = graph.extend(std::move(height));
    Positions result(values.rows(), 3);
    result << plane.real(), plane.imag(), height.real();
    return result;
}

Positions motion_along(const std::vector<int>& indices, const std::vector<TargetMotion::Directions>& ways,
                       const Eigen::VectorXd& unknowns) {
    Positions motion = Positions::Zero(static_cast<Eigen::Index>(indices.size()), 3);
    for (std::size_t v = 0; v < indices.size(); ++v)
        if (const int i = indices[v]; i >= 0)
            motion.row(static_cast<Eigen::Index>(v)) =
                (unknowns[2 * i] * ways[v][0] + unknowns[2 * i + 1] * ways[v][1]).transpose();
    return motion;
}

}  // namespace beltrami
