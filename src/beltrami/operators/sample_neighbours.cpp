#include <beltrami/operators/sample_neighbours.h>

#include <cmath>

#include <beltrami/base/parallel.h>

namespace beltrami {

SampleNeighbours::SampleNeighbours(const Surface& source) : operators_(source.operators) {
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

void SampleNeighbours::smooth(const Eigen::VectorXcd& phase, double part, Eigen::VectorXcd& smoothed) const {
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

/// The samples of a face nearest to the two ends of the edge that starts at a corner. The hat functions of the
/// edge's two corners add up to 1 on it, so their gradient is normal to it.
SampleNeighbours::Side SampleNeighbours::side(const FaceList& faces, int face, int corner) const {
    const int degree = faces.degree(face), j = corner - faces.offsets()[face], k = (j + 1) % degree;
    const auto end = [&](int sample) {
        const auto g = operators_.gradient(sample);
        return End{sample, g[j] + g[k]};
    };
    const int s = first_sample_[face];
    return degree == 3 ? Side{end(s), end(s)} : Side{end(s + j), end(s + k)};
}
SampleNeighbours::Pair SampleNeighbours::join(const End& a, const End& b, bool one_frame) {
    if (one_frame) return {a.sample, b.sample, 1.0};
    const Complex ratio = a.across / b.across;
    return {a.sample, b.sample, ratio * ratio / std::norm(ratio)};
}

}  // namespace beltrami
