#pragma once

#include <optional>
#include <vector>

#include <beltrami/charts/chart.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// A canonical domain with the condition that holds on every part of its boundary: where boundary values are
/// prescribed, or where points slide.
struct MixedDomain {
    /// An arc of a circle or a segment, on which one condition holds.
    struct Part {
        Complex centre = 0;          ///< of the circle
        double radius = 0;           ///< of the circle; 0: a segment
        double from = 0, to = 0;     ///< angles of an arc, from < to ≤ from + 2π
        Complex begin = 0, end = 0;  ///< of a segment
        bool slides = false;
        bool singular_begin = false, singular_end = false;  ///< φ may have a pole or a branch point there
    };
    /// A component of the boundary. Loop 0 is the outer one.
    struct Loop {
        Complex centre = 0;  ///< of the disk that holds the whole domain; of a hole, a place inside
        double radius = 1;
        std::vector<Part> parts;  ///< once around
        /// Places on the circle |z − centre| = radius where the condition changes; an even number.
        std::vector<Complex> transitions;

        /// Whether boundary values are prescribed on some part.
        bool prescribed() const;
    };
    /// A boundary point that is held between two arcs that slide: φ may have a simple pole.
    struct Mark {
        Complex at;
        int loop;
    };
    std::vector<Loop> loops;
    std::vector<Mark> marks;
    std::vector<Complex> pins;                   ///< inner points with a prescribed image: φ may have a simple pole
    std::vector<Singularities::HeldPoint> held;  ///< inner points whose images are held to lines

    /// Whether every loop has one condition all around, so that the dimension of the space of φ is known.
    bool closed() const;
    /// Where functions of the domain vary quickly, for what is sampled on a mesh.
    Singularities singularities() const;
};

/// The domain of a chart to a circle domain.
/// @param held   of every loop of the source, 1 for the vertices whose image is prescribed: edges between two of these
///               are prescribed, all others slide
/// @param pinned vertices inside
/// @pre the vertices of every loop lie on a circle in the chart
MixedDomain mixed_domain(const Surface& source, const Chart& chart, const std::vector<std::vector<char>>& held,
                         const std::vector<int>& pinned);

/// The domain of a planar source in its own coordinates, where those do better than a circle domain: arcs of the outer
/// loop slide along straight sides that meet what is prescribed at right angles. There φ is regular, by reflection, and
/// no error of a chart comes in.
/// @param chart plane_chart of the source
/// @return nothing where an arc is not straight, bends at its ends otherwise or has a mark, or another loop is not
/// round
///         or has two conditions
std::optional<MixedDomain> straight_domain(const Surface& source, const Chart& chart,
                                           const std::vector<std::vector<char>>& held, const std::vector<int>& pinned);

/// Points on the boundary of a domain.
struct BoundarySamples {
    Eigen::VectorXcd places;
    Eigen::VectorXcd squared_tangents;
    Eigen::VectorXd root_weights;  ///< √(length × distance to the ends where φ may be singular)
    std::vector<char> slides;
};

/// Points that resolve powers up to a degree, in panels that shrink geometrically towards ends where φ may be singular.
/// @param shifted places between those that are had without
BoundarySamples boundary_samples(const MixedDomain& domain, int degree, bool shifted);

}  // namespace beltrami
