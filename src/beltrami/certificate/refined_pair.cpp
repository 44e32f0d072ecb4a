#include <beltrami/certificate/refined_pair.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <beltrami/certificate/edge_split.h>
#include <beltrami/mesh/subdivide.h>

namespace beltrami {

namespace {

/// Edges with this part of all that can be gained are halved, and no round begins for less than that part of the bound.
constexpr double kPartOfGain = 0.7, kLeastGain = 2e-3;

/// By which part of itself the energy of a function falls with one more function in the middle of each edge.
/// @param topology of the mesh of the operators
/// @param paired   at the same vertices, with which the function is paired along the boundary; its slope there is what
///                 the energy has to bear
std::vector<double> gains(const Topology& topology, const Operators& operators, const Eigen::VectorXd& function,
                          const Eigen::VectorXd& paired) {
    std::vector<double> slope(static_cast<std::size_t>(topology.edge_count()), 0.0), stiffness = slope;
    std::vector<double> force = slope;
    double energy = 0, pairs = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto corners = operators.stencil(s);
        const auto gradients = operators.gradient(s);
        const double area = operators.weights[s];
        Complex gradient = 0;
        double squares = 0;
        for (int i = 0; i < 3; ++i) {
            gradient += function[corners[i]] * gradients[i];
            squares += area * std::norm(gradients[i]);
        }
        energy += area * std::norm(gradient);
        // ∇ψ of the edge across from a corner has the mean −∇λ of that corner over the face.
        for (int i = 0; i < 3; ++i) {
            const int edge = topology.corner_edges[3 * operators.faces[s] + i];
            slope[edge] -= area * std::real(gradient * std::conj(gradients[(i + 2) % 3]));
            stiffness[edge] += squares;
            const auto& beside = topology.edge_faces[edge];
            if (beside[0] >= 0 && beside[1] >= 0) continue;
            const int from = corners[i], to = corners[(i + 1) % 3];
            force[edge] = 0.5 * (paired[to] - paired[from]);
            pairs += (function[from] + function[to]) * force[edge];
        }
    }
    for (std::size_t e = 0; e < slope.size(); ++e) {
        const double rest = slope[e] - (pairs != 0 ? energy / pairs * force[e] : 0.0);
        slope[e] = rest * rest / (stiffness[e] * energy);
    }
    return slope;
}

/// Marks the fewest edges with a part of all gains.
std::vector<char> marked(const std::vector<double>& gain, double all) {
    std::vector<int> order(gain.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::pair(-gain[a], a) < std::pair(-gain[b], b); });
    std::vector<char> result(gain.size(), 0);
    double sum = 0;
    for (const int e : order) {
        if (sum > kPartOfGain * all) break;
        sum += gain[e];
        result[e] = 1;
    }
    return result;
}

}  // namespace

RefinedPair refined_pair_bound(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                               const RefinedPairOptions& options) {
    RefinedPair result;
    Surface surface = source;
    BoundaryCondition values = boundary;
    Eigen::VectorXcd at = map;
    for (;;) {
        result.faces = surface.mesh.face_count();
        std::optional<BoundaryImage> image = image_under(surface, at);
        if (!image) image = filled_image(surface, at);
        if (!image) return result;
        const PairBound pair = pair_bound(surface, *image);
        result.factorizations += pair.factorizations;
        result.K = std::max(result.K, pair.K);
        if (result.K >= options.enough || result.rounds >= options.most_rounds || result.faces > options.most_faces)
            return result;
        // Along a boundary that has other vertices in the image, what v is paired with is not known at its own.
        const Eigen::VectorXd none = Eigen::VectorXd::Zero(pair.v.size());
        std::vector<double> gain =
            gains(surface.topology, surface.operators, pair.v, image->same_faces ? pair.u : none);
        if (image->same_faces) {
            const std::vector<double> of_image = gains(surface.topology, image->operators, pair.u, pair.v);
            for (std::size_t e = 0; e < gain.size(); ++e) gain[e] += of_image[e];
        }
        const double all = std::accumulate(gain.begin(), gain.end(), 0.0);
        if (!(all > kLeastGain)) return result;
        SplitEdges fine = split_edges(surface, values, marked(gain, all));
        at = with_parents_means(at, fine.ends);
        surface = std::move(fine.surface);
        values = std::move(fine.boundary);
        ++result.rounds;
    }
}

}  // namespace beltrami
