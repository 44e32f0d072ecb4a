#include <beltrami/meshing/triangulation.h>

#include <deque>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/plane/predicates.h>

namespace beltrami {

Triangulation::Triangulation(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const Eigen::Vector2d centre = 0.5 * (low + high);
    const double reach = 8.0 * (high - low).maxCoeff();
    for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        add_vertex(centre + reach * Eigen::Vector2d(x, y));
    }
    add_triangle({{0, 1, 2}, {-1, 1, -1}, {-1, -1, -1}});
    add_triangle({{0, 2, 3}, {-1, -1, 0}, {-1, -1, -1}});
}

int Triangulation::add_vertex(const Eigen::Vector2d& p) {
    points_.push_back(p);
    triangle_of_.push_back(-1);
    return static_cast<int>(points_.size()) - 1;
}

int Triangulation::add_triangle(const Triangle& triangle) {
    triangles_.push_back(triangle);
    const int t = static_cast<int>(triangles_.size()) - 1;
    for (const int vertex : triangle.vertices) triangle_of_[vertex] = t;
    return t;
}

int Triangulation::index_of(int t, int vertex) const {
    const auto& v = triangles_[t].vertices;
    return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
}

int Triangulation::neighbour_index(int t, int neighbour) const {
    const auto& n = triangles_[t].neighbours;
    return n[0] == neighbour ? 0 : n[1] == neighbour ? 1 : 2;
}

Triangulation::Edge Triangulation::twin(Edge edge) const {
    const Triangle& mine = triangles_[edge.triangle];
    const int other = mine.neighbours[edge.index];
    if (other < 0) return {};
    return {other, neighbour_index(other, edge.triangle)};
}

void Triangulation::link(int t, int index, int neighbour, int curve) {
    Triangle& mine = triangles_[t];
    mine.neighbours[index] = neighbour;
    mine.curves[index] = curve;
    if (neighbour < 0) return;
    Triangle& other = triangles_[neighbour];
    for (int k = 0; k < 3; ++k) {
        if (other.vertices[next(k)] == mine.vertices[previous(index)] &&
            other.vertices[previous(k)] == mine.vertices[next(index)]) {
            other.neighbours[k] = t;
            other.curves[k] = curve;
        }
    }
}

int Triangulation::locate(const Eigen::Vector2d& p, int hint) const {
    int t = hint;
    const std::size_t step_limit = 4 * triangles_.size() + 64;
    for (std::size_t step = 0; step < step_limit; ++step) {
        bool arrived = true;
        // The first edge to try changes from step to step, which keeps the walk from going in circles.
        for (int k = 0; k < 3; ++k) {
            const int i = static_cast<int>((step + k) % 3);
            if (orient2d(corner(t, next(i)), corner(t, previous(i)), p) >= 0.0) continue;
            if (triangles_[t].neighbours[i] < 0) break;
            t = triangles_[t].neighbours[i];
            arrived = false;
            break;
        }
        if (arrived) return t;
    }
    for (t = 0; t < static_cast<int>(triangles_.size()); ++t) {
        if (orient2d(corner(t, 0), corner(t, 1), p) >= 0.0 && orient2d(corner(t, 1), corner(t, 2), p) >= 0.0 &&
            orient2d(corner(t, 2), corner(t, 0), p) >= 0.0) {
            return t;
        }
    }
    return hint;
}

int Triangulation::insert(const Eigen::Vector2d& p, int t) {
    int on_edge = -1, edges_through = 0;
    for (int i = 0; i < 3; ++i) {
        if (orient2d(corner(t, next(i)), corner(t, previous(i)), p) == 0.0) {
            on_edge = i;
            ++edges_through;
        }
    }
    if (edges_through > 1) {
        for (const int vertex : triangles_[t].vertices) {
            if (points_[vertex] == p) return vertex;
        }
    }
    if (on_edge >= 0) return split_edge({t, on_edge}, p);
    const int first_new = static_cast<int>(triangles_.size());
    const int vertex = insert_inside(p, t);
    std::vector<int> stack{t, first_new, first_new + 1};
    legalize(stack, vertex);
    return vertex;
}

int Triangulation::insert_inside(const Eigen::Vector2d& p, int t) {
    const int vertex = add_vertex(p);
    const Triangle old = triangles_[t];
    const auto& [a, b, c] = old.vertices;
    const Triangle blank{{vertex, b, c}, {-1, -1, -1}, {-1, -1, -1}, old.inside};
    triangles_[t] = blank;
    const int t1 = add_triangle({{vertex, c, a}, {-1, -1, -1}, {-1, -1, -1}, old.inside});
    const int t2 = add_triangle({{vertex, a, b}, {-1, -1, -1}, {-1, -1, -1}, old.inside});
    triangle_of_[vertex] = triangle_of_[b] = triangle_of_[c] = t;
    link(t, 0, old.neighbours[0], old.curves[0]);
    link(t1, 0, old.neighbours[1], old.curves[1]);
    link(t2, 0, old.neighbours[2], old.curves[2]);
    link(t, 1, t1, -1);
    link(t1, 1, t2, -1);
    link(t2, 1, t, -1);
    return vertex;
}

int Triangulation::split_edge(Edge edge, const Eigen::Vector2d& p) {
    const Edge back = twin(edge);
    if (back.triangle < 0) return -1;
    const Triangle left = triangles_[edge.triangle], right = triangles_[back.triangle];
    const int i = edge.index, j = back.index;
    const int a = left.vertices[i], b = left.vertices[next(i)], c = left.vertices[previous(i)], d = right.vertices[j];
    if (orient2d(p, points_[a], points_[b]) <= 0.0 || orient2d(p, points_[c], points_[a]) <= 0.0 ||
        orient2d(p, points_[b], points_[d]) <= 0.0 || orient2d(p, points_[d], points_[c]) <= 0.0) {
        return -1;
    }
    const int curve = left.curves[i];
    const int vertex = add_vertex(p);
    const std::array<int, 3> none{-1, -1, -1};
    const int ab = edge.triangle, dc = back.triangle;
    triangles_[ab] = {{vertex, a, b}, none, none, left.inside};
    triangles_[dc] = {{vertex, d, c}, none, none, right.inside};
    const int ca = add_triangle({{vertex, c, a}, none, none, left.inside});
    const int bd = add_triangle({{vertex, b, d}, none, none, right.inside});
    triangle_of_[vertex] = triangle_of_[b] = ab;
    link(ab, 0, left.neighbours[previous(i)], left.curves[previous(i)]);
    link(ca, 0, left.neighbours[next(i)], left.curves[next(i)]);
    link(bd, 0, right.neighbours[next(j)], right.curves[next(j)]);
    link(dc, 0, right.neighbours[previous(j)], right.curves[previous(j)]);
    link(ab, 1, bd, curve);
    link(bd, 1, dc, -1);
    link(dc, 1, ca, curve);
    link(ca, 1, ab, -1);
    std::vector<int> stack{ab, ca, bd, dc};
    legalize(stack, vertex);
    return vertex;
}

void Triangulation::legalize(std::vector<int>& stack, int vertex) {
    while (!stack.empty()) {
        const int t = stack.back();
        stack.pop_back();
        const Triangle& mine = triangles_[t];
        if (mine.neighbours[0] < 0 || mine.curves[0] >= 0) continue;
        const Edge back = twin({t, 0});
        if (incircle(points_[vertex], corner(t, 1), corner(t, 2), corner(back.triangle, back.index)) <= 0.0) continue;
        flip({t, 0});
        stack.push_back(t);
        stack.push_back(back.triangle);
    }
}

void Triangulation::flip(Edge edge) {
    const Edge back = twin(edge);
    const int t = edge.triangle, u = back.triangle, i = edge.index, j = back.index;
    const Triangle left = triangles_[t], right = triangles_[u];
    const int a = left.vertices[i], b = left.vertices[next(i)], c = left.vertices[previous(i)], d = right.vertices[j];
    triangles_[t].vertices = {a, b, d};
    triangles_[u].vertices = {a, d, c};
    link(t, 0, right.neighbours[next(j)], right.curves[next(j)]);
    link(t, 2, left.neighbours[previous(i)], left.curves[previous(i)]);
    link(u, 0, right.neighbours[previous(j)], right.curves[previous(j)]);
    link(u, 1, left.neighbours[next(i)], left.curves[next(i)]);
    link(t, 1, u, -1);
    triangle_of_[a] = triangle_of_[b] = triangle_of_[d] = t;
    triangle_of_[c] = u;
}

bool Triangulation::is_convex(Edge edge) const {
    const Edge back = twin(edge);
    const Eigen::Vector2d a = corner(edge.triangle, edge.index), d = corner(back.triangle, back.index);
    return orient2d(a, corner(edge.triangle, next(edge.index)), d) > 0.0 &&
           orient2d(a, d, corner(edge.triangle, previous(edge.index))) > 0.0;
}

Triangulation::Edge Triangulation::find_edge(int a, int b) const {
    // Around a counter-clockwise; from the square's border once more, clockwise.
    for (const bool forward : {true, false}) {
        int t = triangle_of_[a];
        do {
            const int i = index_of(t, a);
            if (triangles_[t].vertices[next(i)] == b) return {t, previous(i)};
            t = triangles_[t].neighbours[forward ? next(i) : previous(i)];
        } while (t >= 0 && t != triangle_of_[a]);
        if (t >= 0) break;
    }
    return {};
}

void Triangulation::star(int vertex, std::vector<int>& triangles) const {
    triangles.clear();
    int t = triangle_of_[vertex];
    do {
        triangles.push_back(t);
        t = triangles_[t].neighbours[next(index_of(t, vertex))];
    } while (t != triangle_of_[vertex]);
}

void Triangulation::constrain(int a, int b, int curve) {
    while (a != b) {
        // The triangle at a through whose far edge (or along whose side) the segment leaves.
        std::vector<int> around;
        star(a, around);
        int stop = -1;
        Edge crossing;
        for (const int t : around) {
            const int i = index_of(t, a);
            const int right = triangles_[t].vertices[next(i)], left = triangles_[t].vertices[previous(i)];
            const double side = orient2d(points_[a], points_[b], points_[right]);
            if (side == 0.0 && (points_[right] - points_[a]).dot(points_[b] - points_[a]) > 0.0) stop = right;
            if (side < 0.0 && orient2d(points_[a], points_[b], points_[left]) > 0.0) crossing = {t, i};
        }
        if (stop < 0) {
            std::deque<std::pair<int, int>> crossed;
            while (stop < 0) {
                const Triangle& mine = triangles_[crossing.triangle];
                if (mine.curves[crossing.index] >= 0) {
                    throw Error(Cause::bad_option,
                                "boundary curves " + std::to_string(mine.curves[crossing.index]) + " and " +
                                    std::to_string(curve) + " cross each other",
                                "give curves that neither cross nor touch",
                                {Things::curves, {mine.curves[crossing.index], curve}});
                }
                crossed.emplace_back(mine.vertices[next(crossing.index)], mine.vertices[previous(crossing.index)]);
                const Edge back = twin(crossing);
                const int apex = triangles_[back.triangle].vertices[back.index];
                const double side = orient2d(points_[a], points_[b], points_[apex]);
                if (side == 0.0) {
                    stop = apex;
                } else {
                    crossing = {back.triangle, side > 0.0 ? next(back.index) : previous(back.index)};
                }
            }
            while (!crossed.empty()) {
                const auto [p, q] = crossed.front();
                crossed.pop_front();
                const Edge edge = find_edge(p, q);
                const Edge back = twin(edge);
                const int left = triangles_[edge.triangle].vertices[edge.index];
                const int right = triangles_[back.triangle].vertices[back.index];
                if (!is_convex(edge)) {
                    crossed.emplace_back(p, q);
                    continue;
                }
                flip(edge);
                const auto strictly_beside = [&](int v) { return v != a && v != stop; };
                if (strictly_beside(left) && strictly_beside(right) &&
                    (orient2d(points_[a], points_[b], points_[left]) > 0.0) !=
                        (orient2d(points_[a], points_[b], points_[right]) > 0.0)) {
                    crossed.emplace_back(left, right);
                }
            }
        }
        const Edge edge = find_edge(a, stop), back = twin(edge);
        int& mark = triangles_[edge.triangle].curves[edge.index];
        if (mark >= 0 && mark != curve) {
            throw Error(Cause::bad_option,
                        "boundary curves " + std::to_string(mark) + " and " + std::to_string(curve) + " overlap",
                        "give curves that neither cross nor touch", {Things::curves, {mark, curve}});
        }
        mark = curve;
        triangles_[back.triangle].curves[back.index] = curve;
        a = stop;
    }
}

void Triangulation::restore_delaunay() {
    std::vector<int> stack(triangles_.size());
    std::vector<char> waiting(triangles_.size(), 1);
    for (std::size_t t = 0; t < stack.size(); ++t) stack[t] = static_cast<int>(stack.size() - 1 - t);
    while (!stack.empty()) {
        const int t = stack.back();
        stack.pop_back();
        waiting[t] = 0;
        for (int i = 0; i < 3; ++i) {
            if (triangles_[t].neighbours[i] < 0 || triangles_[t].curves[i] >= 0) continue;
            const Edge back = twin({t, i});
            if (incircle(corner(t, 0), corner(t, 1), corner(t, 2), corner(back.triangle, back.index)) <= 0.0) continue;
            flip({t, i});
            for (const int changed : {t, back.triangle}) {
                if (!waiting[changed]) stack.push_back(changed);
                waiting[changed] = 1;
            }
            break;
        }
    }
}

void Triangulation::mark_inside() {
    for (Triangle& triangle : triangles_) triangle.inside = false;
    std::vector<char> seen(triangles_.size(), 0);
    std::vector<int> stack{triangle_of_[0]};
    seen[stack[0]] = 1;
    while (!stack.empty()) {
        const int t = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
            const int u = triangles_[t].neighbours[i];
            if (u < 0 || seen[u]) continue;
            seen[u] = 1;
            triangles_[u].inside = triangles_[t].inside != (triangles_[t].curves[i] >= 0);
            stack.push_back(u);
        }
    }
}

}  // namespace beltrami
