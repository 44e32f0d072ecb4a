#include <beltrami/hyperbolic/target_walk.h>

#include <algorithm>

namespace beltrami::detail {

namespace {

constexpr double kOnEdge = 1e-13;
constexpr int kLongestWalk = 1000000;

}  // namespace

TargetWalk walk(const HyperbolicSurface& surface, int h, const DiskIsometry& frame) {
    TargetWalk result{h, frame, {}, {}};
    int inside = 0;
    for (int i = 0; i < kLongestWalk && inside < 3; ++i) {
        const DiskIsometry& step = surface.delaunay_steps[static_cast<std::size_t>(result.halfedge)];
        const Complex head = step.place(), p = result.frame.place();
        const double side = std::imag(std::conj(head) * p);
        const bool crosses = side < -kOnEdge;
        // Proportional to det(p, tail, head) on the hyperboloid: the weight of the corner opposite.
        result.weights[static_cast<std::size_t>(IntrinsicTriangulation::previous(result.halfedge) % 3)] =
            std::max(0.0, side / ((1 - std::norm(head)) * (1 - std::norm(p))));
        result.frame = step.inverse() * result.frame;
        result.way = result.way * step;
        inside = crosses ? 0 : inside + 1;
        result.halfedge =
            crosses ? surface.delaunay.twin(result.halfedge) : IntrinsicTriangulation::next(result.halfedge);
    }
    if (inside < 3) result.halfedge = -1;
    return result;
}

std::vector<int> first_halfedges(const HyperbolicSurface& surface) {
    std::vector<int> result(static_cast<std::size_t>(surface.delaunay.vertex_count()), -1);
    for (int h = surface.delaunay.halfedge_count() - 1; h >= 0; --h) result[surface.delaunay.tail(h)] = h;
    return result;
}

}  // namespace beltrami::detail
