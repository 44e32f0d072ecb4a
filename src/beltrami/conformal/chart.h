#pragma once

#include <string>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// A conformal map of a surface to a canonical domain, in which quadratic differentials are easy to write down.
/// A differential ψ of the domain is pulled back to a sample by φ = ψ(position) · derivative².
struct Chart {
    Eigen::VectorXcd vertices;     ///< #V positions in the canonical domain
    Eigen::VectorXcd positions;    ///< #S the samples' positions
    Eigen::VectorXcd derivatives;  ///< #S ∂ of the chart in the samples' frames
    std::vector<char> excluded;    ///< #S 1 where the chart turns the sample over: its ψ means nothing there
    int excluded_faces = 0;
    bool exact = false;  ///< the chart is the identity up to a similarity, so pulled-back ψ are truly holomorphic
    int factorizations = 0;
    std::vector<std::string> warnings;
};

/// The chart whose vertex positions are @p vertices: derivatives, positions at the samples, excluded samples.
Chart make_chart(const Surface& source, Eigen::VectorXcd vertices, bool exact);

/// Values at the samples of a function given at the vertices: linear on triangles, bilinear on quads.
Eigen::VectorXcd at_samples(const Operators& operators, const Eigen::VectorXcd& values);

}  // namespace beltrami
