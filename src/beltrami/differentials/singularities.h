#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Where the quadratic differentials of a problem may be singular, in the canonical domain: what a space of rational
/// functions is built from, and where samples have to be dense.
struct Singularities {
    /// A hole: powers of r/(z − c) are holomorphic in the domain.
    struct Hole {
        Complex centre;
        double radius;
        int largest_power;  ///< the mesh resolves no more around the hole
    };
    /// A boundary point where φ has a branch point or worse: a corner of the domain, a kink of the boundary values.
    /// Poles cluster towards it from outside.
    struct Corner {
        Complex vertex;
        Complex outward;  ///< of length 1, away from the domain
        double reach;     ///< distance of the farthest pole
        double finest;    ///< distance of the nearest one: below, the mesh resolves nothing
    };
    std::vector<Hole> holes;
    std::vector<Corner> corners;
    std::vector<Complex> pins;  ///< interior points with a prescribed image: φ may have a simple pole

    bool empty() const { return holes.empty() && corners.empty() && pins.empty(); }
    bool only_corners() const { return holes.empty() && pins.empty() && !corners.empty(); }
};

/// The size of quadrature cells: a largest one, smaller near singularities, on whose distance functions vary.
class CellSize {
  public:
    /// @param slope      cell size per distance to the next corner or pin
    /// @param hole_slope cell size per distance to the next hole's centre
    /// @param least      no cell is smaller
    CellSize(double largest, const Singularities& singularities, double slope, double hole_slope, double least);
    explicit CellSize(double largest) : largest_(largest) {}

    double largest() const { return largest_; }
    /// How often the largest size is to be halved at a place.
    int level(Complex z) const;

  private:
    struct Centre {
        Complex at;
        double squared_slope;
    };
    double largest_;
    int deepest_ = 0;
    std::vector<Centre> centres_;
};

}  // namespace beltrami
