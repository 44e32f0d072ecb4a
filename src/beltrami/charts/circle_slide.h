#pragma once

#include <vector>

#include <beltrami/plane/circle_domain.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

struct CircleSlideOptions {
    int max_steps = 30;
    double tolerance = 1e-7;  ///< the last step is one that promises to lower the energy by less than this part
    double least_gap = 1e-3;  ///< circles keep this distance, relative to the smaller radius
};

/// A map of a surface to a circle domain with every rim vertex on its circle, harmonic inside.
struct CircleSlide {
    Eigen::VectorXcd vertices;  ///< #V
    std::vector<RoundHole> holes;
    /// Of every boundary loop, in its order (a hole's backwards): the least angle from a vertex to the next that
    /// sliding leaves. Without it a spike of the rim, which the conformal map makes small, collapses.
    std::vector<std::vector<double>> least_increments;
    double energy = 0;  ///< Σ A|∂̄f|²
    int steps = 0;
    int products = 0;  ///< harmonic solves
    bool converged = false;
    bool too_close = false;  ///< stopped because circles would come closer than allowed
};

/// The rims put onto circles: every rim vertex in its direction from the centre, kept in order.
/// @param vertices    #V positions in the unit disk
/// @param holes       circles, one for every loop but the outer one in their order; made smaller where they would touch
/// @param dirichlet   fixes exactly the boundary, factorised for the coefficient 0: extends the correction harmonically
CircleSlide put_on_circles(const Surface& surface, const BeltramiSolver& dirichlet, int outer_loop,
                           const Eigen::VectorXcd& vertices, std::vector<RoundHole> holes);

/// Newton's method for the least Σ A|∂̄f|² over the angles of the rim vertices on their circles and the holes' centres
/// and radii, three vertices of the outer loop held; f is harmonic inside. The exact second derivatives are applied by
/// one harmonic solve each, with the factor of @p dirichlet; Newton's equations are solved by conjugate gradients,
/// preconditioned by the logarithmic kernel of every circle, which inverts the Dirichlet-to-Neumann map of its disk.
void slide_on_circles(const Surface& surface, const BeltramiSolver& dirichlet, int outer_loop, CircleSlide& map,
                      const CircleSlideOptions& options = {});

}  // namespace beltrami
