#pragma once

#include <beltrami/certificate/quadratic_space.h>

namespace beltrami {

/// Lowers the largest |μ| of a map of a QuadraticSpace: least squares of the part of |∂̄f| that exceeds κ|∂f|, for
/// falling κ, by Gauss-Newton steps with damping. Only where |μ| is large anything moves: the triangles concerned and
/// three rings around them. No step lets more samples be turned over.
class OneSidedDescent {
  public:
    struct Options {
        double least = 0;   ///< k below which no map can come
        double wanted = 0;  ///< k at which it may stop
        int most_stages = 14;
        double least_gain = 0.03;  ///< of a stage, as part of what lies above least
        int rings = 3;
    };

    /// @param held #nodes that stay where they are
    OneSidedDescent(const Surface& source, const QuadraticSpace& space, std::vector<char> held);

    /// Improves the map in place; its largest bound never grows.
    /// @return the largest of space.bounds(map)
    double run(QuadraticMap& map, const Options& options);

    int factorizations() const { return factorizations_; }

  private:
    /// One κ: at most some steps. @return whether anything moved
    bool descend(QuadraticMap& map, const std::vector<double>& bounds, double target, double inner, int rings);

    const Surface& source_;
    const QuadraticSpace& space_;
    std::vector<char> held_;
    std::vector<std::vector<int>> faces_at_;  ///< of every node
    int factorizations_ = 0;
};

}  // namespace beltrami
