#pragma once

#include <span>
#include <vector>

#include <beltrami/operators/operators.h>

namespace beltrami {

/// The samples around every vertex.
class VertexSamples {
  public:
    explicit VertexSamples(const Operators& operators);

    struct Corner {
        int sample;
        int position;  ///< of the vertex in operators.vertices
    };
    /// In the order of the samples.
    std::span<const Corner> operator[](int vertex) const {
        return {corners_.data() + offsets_[vertex], static_cast<std::size_t>(offsets_[vertex + 1] - offsets_[vertex])};
    }

  private:
    std::vector<int> offsets_;
    std::vector<Corner> corners_;
};

}  // namespace beltrami
