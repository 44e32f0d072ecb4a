#include <beltrami/charts/shape.h>

#include <utility>

#include <beltrami/base/error.h>

namespace beltrami {

Shape::Shape(const Surface& surface) : surface_(surface) {}

const Chart& Shape::chart(int outer, const BeltramiSolver* dirichlet) const {
    const std::scoped_lock lock(mutex_);
    if (const auto kept = charts_.find(outer); kept != charts_.end()) return kept->second;
    return charts_.emplace(outer, domain_chart(surface_, outer, dirichlet)).first->second;
}

const CircleDomainChart& Shape::circles(int outer) const {
    const std::scoped_lock lock(mutex_);
    if (const auto kept = circles_.find(outer); kept != circles_.end()) return kept->second;
    return circles_.emplace(outer, circle_domain_chart(surface_, outer)).first->second;
}

std::map<int, CircleDomainChart> Shape::kept_circles() const {
    const std::scoped_lock lock(mutex_);
    return circles_;
}

void Shape::keep(CircleDomainChart circles) const {
    if (circles.chart.vertices.size() != surface_.mesh.vertex_count() ||
        circles.chart.positions.size() != surface_.operators.sample_count())
        throw Error(Cause::bad_option, "the circle domain is one of another surface");
    const std::scoped_lock lock(mutex_);
    circles_.emplace(circles.outer_loop(), std::move(circles));
}

const Shape& Shape::without_bridges() const {
    const std::scoped_lock lock(mutex_);
    if (!examined_) {
        SplitProblem split = split_bridges(surface_);
        if (split.split_edges > 0) {
            split_surface_ = std::make_unique<const Surface>(surface_of(split.mesh, split.metric));
            split_ = std::make_unique<const Shape>(*split_surface_);
            bridges_ = std::move(split);
        }
        examined_ = true;
    }
    return split_ ? *split_ : *this;
}

const Shape* shape_of(const Surface& surface, const std::vector<const Shape*>& shapes) {
    for (const Shape* shape : shapes)
        if (&shape->surface() == &surface) return shape;
    return nullptr;
}

CircleDomainChart circle_domain_of(const Surface& surface, int outer_loop, const std::vector<const Shape*>& shapes) {
    const Shape* shape = shape_of(surface, shapes);
    return shape ? shape->circles(outer_loop) : circle_domain_chart(surface, outer_loop);
}

}  // namespace beltrami
