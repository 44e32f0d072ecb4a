#pragma once

#include <optional>
#include <vector>

#include <beltrami/charts/chart.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// A round disk with round holes, and the points that maps of it keep.
struct RoundDomain {
    struct Disk {
        Complex centre = 0;
        double radius = 1;
    };
    Disk outer;
    std::vector<Disk> holes;
    std::vector<Complex> boundary_marks;  ///< on the circles
    std::vector<Complex> interior_marks;

    int circle_count() const { return static_cast<int>(holes.size()) + 1; }
    /// Circle 0 is the outer one, 1 + i that of hole i.
    const Disk& circle(int i) const { return i == 0 ? outer : holes[i - 1]; }
    /// The circle on which a boundary mark lies: the nearest one.
    int circle_of(Complex mark) const;

    /// Where functions of the domain vary quickly: about the holes and at the marks. What SampledSpace and the c-step
    /// need beside a LaurentSpace. The largest powers of the holes are not meant.
    Singularities singularities() const;

    /// @throw Error bad_option naming holes that meet each other or the outer circle, marks that are not where they
    /// belong (to a millionth of the outer radius) and marks that coincide
    void validate() const;
};

/// The domain of a chart whose boundary loops are circles.
/// @param marked vertices of the source, on the boundary or inside
/// @param tolerance of the loops' vertices, relative to their circles' radii
/// @return nothing if a loop is no circle
std::optional<RoundDomain> round_domain(const Surface& source, const Chart& chart, const std::vector<int>& marked = {},
                                        double tolerance = 1e-7);

}  // namespace beltrami
