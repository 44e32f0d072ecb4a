#include <beltrami/uniformize/flatten_layout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <queue>
#include <vector>

namespace beltrami {

Layout lay_out(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& u) {
    const auto next = IntrinsicTriangulation::next, previous = IntrinsicTriangulation::previous;
    Layout result;
    result.positions = Eigen::VectorXcd::Zero(triangulation.vertex_count());
    if (triangulation.triangle_count() == 0) return result;

    int first = 0;
    for (int h = 1; h < triangulation.halfedge_count(); ++h)
        if (triangulation.log_length(h, u) > triangulation.log_length(first, u)) first = h;

    // A triangle inherits the direction of the edge it was entered by (as an angle) and that edge's start, both from
    // one neighbour alone. Building instead on points that came by different ways would turn their mismatch into a
    // rotation of all that follows, over and over: errors would grow exponentially.
    struct Entrance {
        int halfedge;
        double direction;
        Complex start;
    };
    std::vector<char> placed(static_cast<std::size_t>(triangulation.vertex_count()), 0);
    std::vector<char> reached(static_cast<std::size_t>(triangulation.triangle_count()), 0);
    const auto place = [&](int vertex, Complex position) {
        if (!placed[vertex]) result.positions[vertex] = position;
        placed[vertex] = 1;
    };
    const auto along = [&](int h, double direction) {
        return std::polar(std::exp(triangulation.log_length(h, u)), direction);
    };
    std::queue<Entrance> waiting;
    waiting.push({first, 0, 0});
    reached[first / 3] = 1;
    place(triangulation.tail(first), 0);
    place(triangulation.head(first), along(first, 0));
    while (!waiting.empty()) {
        const auto [h, direction, start] = waiting.front();
        waiting.pop();
        const std::array<double, 3> angles = triangulation.angles(h / 3, u).angles;
        const double at_tail = angles[next(h) % 3], at_apex = angles[h % 3];
        const double back = direction + at_tail;  // from the tail to the apex
        const Complex apex = start + along(previous(h), back);
        place(triangulation.tail(previous(h)), apex);
        const auto cross = [&](int side, double side_direction, Complex side_start) {
            const int twin = triangulation.twin(side);
            if (twin < 0 || reached[twin / 3]) return;
            reached[twin / 3] = 1;
            waiting.push({twin, side_direction, side_start});
        };
        // Entered from the other side, an edge runs the other way: apex → head, and tail → apex.
        cross(next(h), back + at_apex - std::numbers::pi, apex);
        cross(previous(h), back, start);
        if (h == first) cross(first, direction + std::numbers::pi, along(first, direction));
    }

    Complex sum = 0;
    int count = 0;
    for (int v = 0; v < triangulation.vertex_count(); ++v) {
        if (!placed[v]) continue;
        sum += result.positions[v];
        ++count;
    }
    double left = 0, right = 0, bottom = 0, top = 0;
    for (int v = 0; v < triangulation.vertex_count(); ++v) {
        if (!placed[v]) continue;
        const Complex z = result.positions[v] -= sum / static_cast<double>(count);
        left = std::min(left, z.real());
        right = std::max(right, z.real());
        bottom = std::min(bottom, z.imag());
        top = std::max(top, z.imag());
    }
    for (int h = 0; h < triangulation.halfedge_count(); ++h) {
        const Complex edge = result.positions[triangulation.head(h)] - result.positions[triangulation.tail(h)];
        result.error = std::max(result.error, std::abs(std::abs(edge) - std::exp(triangulation.log_length(h, u))));
    }
    result.error /= std::hypot(right - left, top - bottom);
    return result;
}

}  // namespace beltrami
