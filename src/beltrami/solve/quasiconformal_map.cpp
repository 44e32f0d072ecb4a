#include <beltrami/solve/quasiconformal_map.h>

#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

void require_coefficient(const Surface& source, const Eigen::VectorXcd& mu) {
    if (mu.size() != source.operators.sample_count())
        throw Error(Cause::bad_option,
                    "the coefficient has " + std::to_string(mu.size()) + " values, the source " +
                        std::to_string(source.operators.sample_count()) + " samples",
                    "give one value for every triangle, four for every quad");
    std::vector<int> bad;
    for (Eigen::Index s = 0; s < mu.size(); ++s)
        if (!(std::abs(mu[s]) < 1)) bad.push_back(static_cast<int>(s));
    if (bad.empty()) return;
    const std::string sentence = "the coefficient is not below 1 in size at " + std::to_string(bad.size()) +
                                 " samples, the first of them " + std::to_string(bad[0]);
    throw Error(Cause::bad_option, sentence, "every |μ| must be finite and below 1", {Things::samples, std::move(bad)});
}

Eigen::VectorXcd quasiconformal_map(const Surface& source, const Eigen::VectorXcd& mu,
                                    const BoundaryCondition& boundary) {
    require_coefficient(source, mu);
    validate(boundary, source);
    BeltramiSolver solver(source, freedoms(boundary, source), 1);
    solver.factorize(mu, line_directions(boundary, source));
    return solver.solve(prescribed_values(boundary, source));
}

}  // namespace beltrami
