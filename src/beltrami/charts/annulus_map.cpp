#include <beltrami/charts/annulus_map.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <beltrami/base/constants.h>
#include <beltrami/mesh/strip.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

/// Harmonic, 0 on one loop and 1 on the other.
Eigen::VectorXd potential(const Surface& surface, int outer_loop) {
    BoundaryCondition boundary;
    for (int l = 0; l < 2; ++l)
        for (const int v : surface.topology.boundary_loops[l]) boundary.pin(v, l == outer_loop ? 0.0 : 1.0);
    return harmonic_map(surface, boundary).real();
}

/// The function of period ±1 with the least Dirichlet energy: the solution v of min Σ A |∇(v + jumps)|².
Eigen::VectorXd periodic_harmonic(const Surface& surface, const std::vector<double>& jumps) {
    const Operators& operators = surface.operators;
    std::vector<char> held(static_cast<std::size_t>(operators.vertex_count), 0);
    held[surface.topology.boundary_loops[0][0]] = 1;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(operators.vertex_count);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        const auto gradient = operators.gradient(s);
        const double* jump = &jumps[surface.mesh.faces.first_corner(operators.faces[s])];
        Complex slope = 0;
        for (std::size_t i = 0; i < gradient.size(); ++i) slope += jump[i] * gradient[i];
        if (slope == 0.0) continue;
        for (std::size_t i = 0; i < gradient.size(); ++i)
            force[stencil[i]] -= operators.weights[s] * std::real(std::conj(gradient[i]) * slope);
    }
    return detail::Laplacian(operators, held).solve(force);
}

/// Of the annulus whose turn has the length 2π.
double strip_height(const AnnulusPotentials& potentials) {
    return kTurn * std::sqrt(potentials.v_energy / potentials.u_energy);
}

}  // namespace

AnnulusPotentials annulus_potentials(const Surface& surface, int outer_loop) {
    const Operators& operators = surface.operators;
    const FaceList& faces = surface.mesh.faces;
    AnnulusPotentials result;
    result.u = potential(surface, outer_loop);
    const std::vector<double> jumps = jumps_across_strip(surface.mesh, surface.topology, outer_loop, 1 - outer_loop);
    result.v = periodic_harmonic(surface, jumps);
    double turning = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        const auto gradient = operators.gradient(s);
        const double* jump = &jumps[faces.first_corner(operators.faces[s])];
        Complex du = 0, dv = 0;
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            du += result.u[stencil[j]] * gradient[j];
            dv += (result.v[stencil[j]] + jump[j]) * gradient[j];
        }
        result.u_energy += operators.weights[s] * std::norm(du);
        result.v_energy += operators.weights[s] * std::norm(dv);
        turning += operators.weights[s] * std::imag(std::conj(du) * dv);
    }
    // −u grows outwards, the angle counter-clockwise: the gradient of the angle is that of −u turned by 90°.
    const double sense = turning < 0 ? 1 : -1;
    result.v *= sense;
    // Along boundary edges, by the jumps of the faces beside them.
    std::vector<double> after(surface.mesh.vertex_count(), 0.0);
    for (int f = 0; f < faces.size(); ++f)
        for (int c = faces.first_corner(f), end = c + faces.degree(f), first = c; c < end; ++c) {
            const auto& sides = surface.topology.edge_faces[surface.topology.corner_edges[c]];
            const int next = c + 1 < end ? c + 1 : first;
            if (sides[0] < 0 || sides[1] < 0)
                after[faces.vertices()[c]] =
                    result.v[faces.vertices()[next]] - result.v[faces.vertices()[c]] + sense * (jumps[next] - jumps[c]);
        }
    for (const auto& loop : surface.topology.boundary_loops) {
        auto& increments = result.increments.emplace_back();
        for (const int v : loop) increments.push_back(after[v]);
    }
    return result;
}

Eigen::VectorXcd annulus_map(const Surface& surface, int outer_loop) {
    const AnnulusPotentials potentials = annulus_potentials(surface, outer_loop);
    const double modulus = strip_height(potentials);
    Eigen::VectorXcd g(potentials.u.size());
    for (Eigen::Index i = 0; i < g.size(); ++i)
        g[i] = std::polar(std::exp(-modulus * potentials.u[i]), kTurn * potentials.v[i]);
    return g;
}

AnnulusStrip annulus_strip(const Surface& surface, int outer_loop) {
    const AnnulusPotentials potentials = annulus_potentials(surface, outer_loop);
    const FaceList& faces = surface.mesh.faces;
    AnnulusStrip strip{Eigen::VectorXcd(faces.corner_count()), strip_height(potentials)};
    for (int f = 0; f < faces.size(); ++f) {
        const double first = potentials.v[faces[f][0]];
        for (int j = 0; j < faces.degree(f); ++j) {
            const double v = potentials.v[faces[f][j]];
            strip.corners[faces.first_corner(f) + j] = {kTurn * (v - std::round(v - first)),
                                                        strip.height * potentials.u[faces[f][j]]};
        }
    }
    return strip;
}

}  // namespace beltrami
