#pragma once

#include <optional>

#include <beltrami/charts/chart.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

/// How a conjugate harmonic function is found: on the boundary from the flux and inside by one more solve, or as the
/// solution of a system of its own, ten times the work and less sensitive to badly shaped faces at the boundary.
enum class ConjugateBy { flux, system };

/// The conformal map of a disk-like surface to the unit disk, 0 at one vertex deep inside: Riemann's construction
/// g = exp(G + iG*) by Green's function G of the surface itself, so that nothing but a patch around the pole has to be
/// flattened.
///
/// With w the patch's flattening, w(p) = 0, g = w exp(h + ih*) on the patch and exp(h + ih*) outside, where h + ih*
/// is made to jump by log w at the rim: inside the derivatives ∂̄(h + ih*) have to vanish, outside
/// ∂̄(h + ih*) = −∂̄λ, λ any function with the values of log w on the rim and the period 2πi around the patch. Which
/// one is taken makes no difference: h + ih* makes up for it. h = 0 on the boundary is one solve with the Dirichlet
/// solver (in its weak form the angle of λ gives the flux of log|w| through the rim), h* another.
/// @param dirichlet      fixes exactly the boundary and is factorised for the coefficient 0
/// @param factorizations counts those made
/// @return #V, |g| = 1 on the boundary up to discretisation; nothing where no patch of more than a few faces fits
///         around the deepest vertex, or its flattening turns faces over
/// @pre one component, one boundary loop, genus 0
std::optional<Eigen::VectorXcd> disk_map_by_greens_function(const Surface& source, const BeltramiSolver& dirichlet,
                                                            ConjugateBy way, int* factorizations);

/// What these maps have in common, whichever way h* is found.
struct GreensFunction {
    Eigen::VectorXd regular;  ///< #V h
    Eigen::VectorXcd factor;  ///< #V w on the patch, else 1
    Eigen::VectorXcd offset;  ///< #S ∂̄λ outside the patch, else 0
    int cut_corner = -1;      ///< where the boundary edge begins along which λ turns by 2πi
};
/// @return nothing where disk_map_by_greens_function returns nothing
std::optional<GreensFunction> greens_function(const Surface& source, const BeltramiSolver& dirichlet);
Eigen::VectorXcd disk_map_by_greens_function(const Surface& source, const BeltramiSolver& dirichlet,
                                             const GreensFunction& of, ConjugateBy way, int* factorizations);

/// h + i h* with ∂̄(h + i h*) + r ≈ 0 for the h that is harmonic in this sense. By flux: h* on the boundary is summed
/// up from the flux of h, which the finite elements know to second order; h* = 0 in the middle of the edge before the
/// first boundary vertex. By a system: Σ A |∂̄(h + i h*) + r|² is least, h* = 0 at the first boundary vertex.
/// @param dirichlet  fixes exactly the boundary and is factorised for the coefficient 0
/// @param h          Re of dirichlet.solve(boundary values, offset)
/// @param offset     #S the r of every sample, or empty for 0
/// @param cut_corner where r = ∂̄λ and λ turns by 2πi along a boundary edge: the corner at which that edge begins
/// @param factorizations counts those made
Eigen::VectorXcd with_conjugate(const Surface& source, const BeltramiSolver& dirichlet, ConjugateBy way,
                                const Eigen::VectorXd& h, const Eigen::VectorXcd& offset, int cut_corner,
                                int* factorizations);

}  // namespace beltrami
