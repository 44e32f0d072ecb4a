#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// What tells classes of maps of a disk with holes that agree in where pinned vertices go: the images of arcs that
/// join a pinned vertex to the other ones and to holes, each as the reduced word in which it crosses the rays that go
/// straight up from the points that it cannot cross: images of pins and the middles of holes. How often an arc turns
/// around its own ends does not count. Two maps with the same words can be deformed into each other, pins held and
/// boundaries sliding, and else cannot.
class ArcWords {
  public:
    /// @param pins   vertices inside, the first joined to all others
    /// @param marked vertices of the boundary that are held
    /// @throw Error bad_mesh where no path of edges joins two of them past the others
    ArcWords(const Surface& source, std::vector<int> pins, const std::vector<int>& marked, int outer_loop);

    /// Crossings one after another: ±(number of the point + 1), positive from left to right.
    using Words = std::vector<std::vector<int>>;
    /// @param map     #V images
    /// @param middles of holes, in the order of the loops without the outer one
    Words of(const Eigen::VectorXcd& map, const std::vector<Complex>& middles) const {
        return of(images(map, middles), places_of_pins(map), middles);
    }

    /// The arcs themselves, as polylines of the plane that may be moved, and their words then.
    using Polylines = std::vector<std::vector<Complex>>;
    Polylines images(const Eigen::VectorXcd& map, const std::vector<Complex>& middles) const;
    std::vector<Complex> places_of_pins(const Eigen::VectorXcd& map) const;
    /// @param pins where they are then
    Words of(const Polylines& arcs, const std::vector<Complex>& pins, const std::vector<Complex>& middles) const;

  private:
    struct Arc {
        std::vector<int> vertices;  ///< from the first pin
        int end = -1;               ///< the number of the point at which it ends; −1: a marked vertex
        bool to_middle = false;     ///< of a hole, from the last vertex on
    };
    std::vector<int> pins_;
    std::vector<Arc> arcs_;
};

}  // namespace beltrami
