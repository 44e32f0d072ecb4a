#include <beltrami/solve/dirichlet_solver.h>

namespace beltrami {

std::vector<Freedom> dirichlet_freedoms(const Surface& source) {
    std::vector<Freedom> result(source.mesh.vertex_count(), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v]) result[v] = Freedom::free;
    return result;
}

BeltramiSolver dirichlet_solver(const Surface& source) {
    BeltramiSolver solver(source, dirichlet_freedoms(source), 1);
    solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()));
    return solver;
}

}  // namespace beltrami
