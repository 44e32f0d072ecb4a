#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

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
    /// A curve of inner edges with prescribed images, across which φ may jump: by anything where its points are pinned;
    /// where they are held to a line so that the jump of φ dz² is real along it (points may slide, so ∫φ ∂̄V vanishes
    /// for every V that is tangent to the curve).
    struct Curve {
        std::vector<Complex> points;  ///< those of the curve, and before and after them its continuations outside
        int first, last;              ///< the first and last point of the curve itself
        bool real;
        bool closed;  ///< points[last] is points[first]
    };
    /// An inner point whose image is held to a line: φ may have the pole y·residue/(z − at) for real y. With V the
    /// direction in which the point may move, Re(residue · V) = 0.
    struct HeldPoint {
        Complex at, residue;
    };
    std::vector<Hole> holes;
    std::vector<Corner> corners;
    std::vector<Complex> pins;  ///< interior points with a prescribed image: φ may have a simple pole
    std::vector<Curve> curves;
    std::vector<HeldPoint> held;

    bool empty() const { return holes.empty() && corners.empty() && pins.empty() && curves.empty() && held.empty(); }
    bool only_corners() const {
        return holes.empty() && pins.empty() && curves.empty() && held.empty() && !corners.empty();
    }
    /// Whether only real combinations of some functions are admissible.
    bool real() const {
        for (const Curve& curve : curves)
            if (curve.real) return true;
        return !held.empty();
    }
};

/// The size of quadrature cells: a largest one, smaller near singularities, on whose distance functions vary.
class CellSize {
  public:
    /// @param slope      cell size per distance to the next corner, pin or curve: no cell has places on both sides of a
    ///                   curve where it is less than 1
    /// @param hole_slope cell size per distance to the next hole's centre
    /// @param least      no cell is smaller
    CellSize(double largest, const Singularities& singularities, double slope, double hole_slope, double least);
    explicit CellSize(double largest) : largest_(largest) {}
    /// Cells are also smaller near the unit circle, on the inside.
    /// @param slope cell size per distance to the circle
    /// @param least the circle makes no cell smaller than this
    void shrink_towards_circle(double slope, double least);

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
    std::vector<std::array<Complex, 2>> edges_;  ///< of the curves
    double squared_slope_ = 0;                   ///< of these
    double circle_slope_ = 0, least_at_circle_ = 0;
};

}  // namespace beltrami
