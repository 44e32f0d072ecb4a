#include "problems/construct.h"

#include <algorithm>

#include <beltrami/base/error.h>

namespace beltrami::bench {

Eigen::VectorXcd values(const Mesh& mesh, const PlaneMap& f) {
    Eigen::VectorXcd result(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) result[v] = f(place(mesh, v));
    return result;
}

Problem with_boundary_values(std::string name, std::string statement, Mesh mesh, const PlaneMap& f) {
    Problem problem;
    problem.name = std::move(name);
    problem.statement = std::move(statement);
    for (const auto& loop : topology(mesh).boundary_loops)
        for (const int v : loop) problem.boundary.pin(v, f(place(mesh, v)));
    problem.mesh = std::move(mesh);
    return problem;
}

Problem with_homeomorphism(std::string name, std::string statement, Mesh mesh, const PlaneMap& f) {
    Problem problem = with_boundary_values(std::move(name), std::move(statement), std::move(mesh), f);
    problem.witness = values(problem.mesh, f);
    return problem;
}

Problem with_exact_map(std::string name, std::string statement, Mesh mesh, const PlaneMap& f, double k) {
    Problem problem = with_homeomorphism(std::move(name), std::move(statement), std::move(mesh), f);
    problem.exact = problem.witness;
    problem.exact_k = k;
    return problem;
}

void pin_sides(BoundaryCondition& boundary, const Mesh& mesh, const std::vector<int>& loop,
               const std::vector<int>& vertices, const std::vector<Complex>& corners) {
    const std::size_t n = loop.size();
    for (std::size_t side = 0; side < vertices.size(); ++side) {
        const int first = vertices[side], last = vertices[(side + 1) % vertices.size()];
        std::size_t i = std::find(loop.begin(), loop.end(), first) - loop.begin();
        if (i == n) throw Error(Cause::bad_option, "a corner is not on the loop", "", {Things::vertices, {first}});
        std::vector<int> chain{first};
        std::vector<double> lengths{0};
        do {
            const int v = loop[++i % n];
            lengths.push_back(lengths.back() + (mesh.point(v) - mesh.point(chain.back())).norm());
            chain.push_back(v);
            if (chain.size() > n + 1)
                throw Error(Cause::bad_option, "a corner is not on the loop", "", {Things::vertices, {last}});
        } while (chain.back() != last);
        const Complex from = corners[side], to = corners[(side + 1) % corners.size()];
        for (std::size_t j = 0; j + 1 < chain.size(); ++j)
            boundary.pin(chain[j], from + lengths[j] / lengths.back() * (to - from));
    }
}

int vertex_at(const Mesh& mesh, Complex where) {
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (std::abs(place(mesh, v) - where) < 1e-9) return v;
    throw Error(Cause::bad_option, "no vertex at the place wanted");
}

}  // namespace beltrami::bench
