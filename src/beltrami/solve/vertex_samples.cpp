#include <beltrami/solve/vertex_samples.h>

#include <numeric>

namespace beltrami {

VertexSamples::VertexSamples(const Operators& operators)
    : offsets_(static_cast<std::size_t>(operators.vertex_count) + 1, 0), corners_(operators.vertices.size()) {
    for (const int v : operators.vertices) ++offsets_[v + 1];
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    std::vector<int> fill(offsets_.begin(), offsets_.end() - 1);
    for (int s = 0; s < operators.sample_count(); ++s)
        for (int c = operators.offsets[s]; c < operators.offsets[s + 1]; ++c)
            corners_[fill[operators.vertices[c]]++] = {s, c};
}

}  // namespace beltrami
