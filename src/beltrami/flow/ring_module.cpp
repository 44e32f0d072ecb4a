#include <beltrami/flow/ring_module.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/solve/quasiconformal_map.h>

namespace beltrami {

namespace {

/// Face corners (#corners×2) in the structure of μ: w + μ w̄ of those in the frame of the face's
/// sample (triangles).
Positions corners_in(const Surface& source, const Eigen::VectorXcd& mu) {
    const Operators& operators = source.operators;
    Positions corners(source.mesh.faces.corner_count(), 2);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const int first = source.mesh.faces.first_corner(operators.faces[s]);
        const auto stencil = operators.stencil(s);
        const auto g = operators.gradient(s);
        // g_j = i (w_{j+2} − w_{j+1})/2A of a triangle.
        const double twice = 2 * operators.weights[s];
        const std::array<Complex, 3> w{0.0, g[2] * twice * Complex(0, -1), -g[1] * twice * Complex(0, -1)};
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const Complex place = w[j] + mu[s] * std::conj(w[j]);
            corners.row(first + static_cast<int>(j)) << place.real(), place.imag();
        }
    }
    return corners;
}

}  // namespace

double ring_module(const Surface& source, const Eigen::VectorXcd& mu, int outer_loop) {
    require_genus_zero(source);
    if (source.topology.boundary_loops.size() != 2)
        throw Error(Cause::bad_mesh, "a ring has two boundary loops, the surface has " +
                                         std::to_string(source.topology.boundary_loops.size()));
    require_coefficient(source, mu);
    if (source.operators.sample_count() != source.mesh.face_count())
        throw Error(Cause::bad_mesh, "the module is found on triangles, the surface has quads", "cut them in two");
    const Surface structure(source.mesh, corners_in(source, mu));
    const AnnulusPotentials found = annulus_potentials(structure, outer_loop);
    return 2 * std::numbers::pi / std::sqrt(found.u_energy / found.v_energy);
}

}  // namespace beltrami
