#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A conformal map of a surface to a canonical domain, in which quadratic differentials are easy to write down.
/// A differential ψ of the domain is pulled back to a sample by φ = ψ(position) · derivative².
struct Chart {
    Eigen::VectorXcd vertices;  ///< #V positions in the canonical domain; empty where corners has them
    /// #corners positions where a vertex may have several: of an atlas whose parts lie side by side. Else empty.
    Eigen::VectorXcd corners;
    Eigen::VectorXcd positions;    ///< #S the samples' positions
    Eigen::VectorXcd derivatives;  ///< #S ∂ of the chart in the samples' frames
    std::vector<char> excluded;  ///< #S 1 where the chart has |μ| ≥ ½ or turns the sample over: ψ means nothing there
    int excluded_faces = 0;
    /// The chart is holomorphic on the plane of the mesh (a similarity, or analytic below), so that pulled-back ψ are
    /// truly holomorphic.
    bool exact = false;
    /// Of an exact chart: its position and derivative at a place of planar_coordinates(mesh). Positions and derivatives
    /// are its values at the samples. May be empty for a similarity, whose derivative is constant.
    std::function<std::array<Complex, 2>(Complex)> analytic;

    /// A hole of the canonical domain.
    struct Hole {
        int loop;        ///< of the source's boundary loops
        Complex centre;  ///< a place well inside
        double radius;   ///< about its size: every rim vertex is at least half of it away from the centre
    };
    int outer_loop = 0;       ///< the boundary loop that goes to the unit circle
    std::vector<Hole> holes;  ///< one for every other loop, in their order
    int factorizations = 0;
    Warnings warnings;
};

/// The chart whose vertex positions are @p vertices: derivatives, positions at the samples, excluded samples.
Chart make_chart(const Surface& source, Eigen::VectorXcd vertices, bool exact);

/// The same of positions of the face corners (#corners), no longer exact.
Chart make_atlas(const Surface& source, Eigen::VectorXcd corners);

/// The part of the chart's area in samples that it flips, or so distorts that their shape there is none: |μ| ≥
/// .95.
double unseen_part(const Surface& source, const Chart& chart);
/// Whether it does so to a sample.
bool unseen(const Operators& operators, int sample, const Chart& chart);

/// Values at the samples of a function given at the vertices: linear on triangles, bilinear on quads.
Eigen::VectorXcd at_samples(const Operators& operators, const Eigen::VectorXcd& values);

}  // namespace beltrami
