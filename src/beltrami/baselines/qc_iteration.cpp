#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/baselines/start.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

/// |μ| counts as at most this in the mean, so that flipped faces do not spoil it.
constexpr double kMostMu = 0.95;

/// Samples beside each other, with the factors that turn a neighbour's coefficient into a sample's frame.
class Neighbours {
  public:
    explicit Neighbours(const Surface& source) : operators_(source.operators) {
        const Topology& topology = source.topology;
        const FaceList& faces = source.mesh.faces;
        first_sample_.assign(faces.size(), 0);
        for (int s = operators_.sample_count() - 1; s >= 0; --s) first_sample_[operators_.faces[s]] = s;
        std::vector<Pair> pairs;
        for (int f = 0; f < faces.size(); ++f)
            if (faces.degree(f) == 4)
                for (int j = 0; j < 4; ++j)
                    pairs.push_back({first_sample_[f] + j, first_sample_[f] + (j + 1) % 4, 1.0});  // one frame
        std::vector<int> first_corner(topology.edge_count(), -1);
        for (int f = 0; f < faces.size(); ++f)
            for (int c = faces.offsets()[f]; c < faces.offsets()[f + 1]; ++c) {
                const int e = topology.corner_edges[c];
                const auto [a, b] = topology.edge_faces[e];
                if (a < 0 || b < 0) continue;
                if (first_corner[e] < 0) {
                    first_corner[e] = c;
                    continue;
                }
                const int other = a == f ? b : a;
                const Side here = side(faces, f, c), there = side(faces, other, first_corner[e]);
                pairs.push_back(join(here.start, there.end, source.in_plane()));
                if (here.start.sample != here.end.sample || there.start.sample != there.end.sample)
                    pairs.push_back(join(here.end, there.start, source.in_plane()));
            }
        offsets_.assign(operators_.sample_count() + 1, 0);
        for (const Pair& pair : pairs) ++offsets_[pair.a + 1], ++offsets_[pair.b + 1];
        for (int s = 0; s < operators_.sample_count(); ++s) offsets_[s + 1] += offsets_[s];
        samples_.resize(offsets_.back());
        turns_.resize(offsets_.back());
        std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
        for (const Pair& pair : pairs) {
            samples_[next[pair.a]] = pair.b;
            turns_[next[pair.a]++] = pair.b_to_a;
            samples_[next[pair.b]] = pair.a;
            turns_[next[pair.b]++] = std::conj(pair.b_to_a);
        }
    }

    /// One Jacobi step of smoothing the arguments of complex numbers, which keep no size: every argument goes by this
    /// part of the way to those of the neighbours, an edge without a neighbour counting as one that agrees.
    /// @param phase    #S, in the samples' frames
    /// @param smoothed #S of modulus 1
    void smooth(const Eigen::VectorXcd& phase, double part, Eigen::VectorXcd& smoothed) const {
        parallel_for(0, static_cast<int>(phase.size()), [&](int first, int last) {
            for (int s = first; s < last; ++s) {
                double turn = 0;
                for (int n = offsets_[s]; n < offsets_[s + 1]; ++n)
                    turn += std::arg(phase[samples_[n]] * turns_[n] * std::conj(phase[s]));
                const auto edges = static_cast<double>(operators_.stencil(s).size());
                smoothed[s] = std::polar(1.0, std::arg(phase[s]) + part * turn / edges);
            }
        });
    }

  private:
    struct Pair {
        int a, b;
        Complex b_to_a;
    };
    struct End {
        int sample;
        Complex across;  // normal to the edge in the sample's frame
    };
    struct Side {
        End start, end;
    };

    /// The samples of a face nearest to the two ends of the edge that starts at a corner. The hat functions of the
    /// edge's two corners add up to 1 on it, so their gradient is normal to it.
    Side side(const FaceList& faces, int face, int corner) const {
        const int degree = faces.degree(face), j = corner - faces.offsets()[face], k = (j + 1) % degree;
        const auto end = [&](int sample) {
            const auto g = operators_.gradient(sample);
            return End{sample, g[j] + g[k]};
        };
        const int s = first_sample_[face];
        return degree == 3 ? Side{end(s), end(s)} : Side{end(s + j), end(s + k)};
    }
    static Pair join(const End& a, const End& b, bool one_frame) {
        if (one_frame) return {a.sample, b.sample, 1.0};
        const Complex ratio = a.across / b.across;
        return {a.sample, b.sample, ratio * ratio / std::norm(ratio)};
    }

    const Operators& operators_;
    std::vector<int> first_sample_;  // #F
    std::vector<int> offsets_, samples_;
    std::vector<Complex> turns_;
};

}  // namespace

BaselineMap qc_iteration_baseline(const Surface& source, const BoundaryCondition& boundary,
                                  const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    require_whole_boundary(boundary, source);
    const Operators& operators = source.operators;
    const int samples = operators.sample_count();
    BaselineMap result;
    BeltramiSolver solver(source, freedoms(boundary, source), 10);
    const Eigen::VectorXcd prescribed = prescribed_values(boundary, source);
    Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(samples);
    solver.factorize(nu);
    result.map = solver.solve(prescribed);
    result.factorizations = 1;
    if (detail::must_fold(source, boundary, result)) return result;

    const Neighbours neighbours(source);
    const double area = operators.area(), image_area = detail::enclosed_area(source, boundary);
    Eigen::VectorXcd phase(samples), smoothed(samples);
    // The next coefficient from the map; returns by how much it differs from the last, root mean square.
    const auto next_coefficient = [&] {
        double mean = 0;
        for (int s = 0; s < samples; ++s) {
            const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
            phase[s] = d_zbar * std::conj(d_z);
            const double size = std::abs(d_z), other = std::abs(d_zbar);
            mean += other < kMostMu * size ? other / size : other > 0 ? kMostMu : 0.0;
            phase[s] = size > 0 && other > 0 ? phase[s] / (size * other) : Complex(1);
        }
        mean /= samples;
        neighbours.smooth(phase, options.smoothing, smoothed);
        double change = 0;
        for (int s = 0; s < samples; ++s) {
            const Complex next = mean * smoothed[s];
            change += operators.weights[s] * std::norm(next - nu[s]);
            nu[s] = next;
        }
        return std::sqrt(change / area);
    };
    const auto energy = [&] {
        double sum = 0;
        for (int s = 0; s < samples; ++s) {
            const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
            sum += operators.weights[s] * std::norm(d_zbar - nu[s] * d_z);
        }
        return sum / image_area;
    };

    result.converged = next_coefficient() <= options.tolerance;
    while (!result.converged && result.iterations < options.max_iterations) {
        result.map = solver.solve_near(nu, prescribed, result.map);
        ++result.iterations;
        if (options.progress && !options.progress(result.iterations, energy()))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));
        result.converged = next_coefficient() <= options.tolerance;
    }
    result.factorizations = solver.factorization_count();
    if (!result.converged)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before the coefficient settled");
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
