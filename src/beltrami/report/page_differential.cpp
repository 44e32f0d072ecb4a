#include <beltrami/report/page_differential.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/operators/frames.h>

namespace beltrami {

PageDifferential page_differential(const Surface& surface, const Eigen::VectorXcd& phi,
                                   const QuadraticDifferential& differential) {
    const Eigen::VectorXcd along = phi_along_first_edge(surface, phi);
    Eigen::VectorXcd sums = Eigen::VectorXcd::Zero(surface.mesh.face_count());
    for (Eigen::Index s = 0; s < along.size(); ++s) sums[surface.operators.faces[s]] += along[s];
    PageDifferential result;
    result.angles.setConstant(sums.size(), std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index face = 0; face < sums.size(); ++face) {
        if (!(std::abs(sums[face]) > 0)) continue;
        const double angle = -0.5 * std::arg(sums[face]);
        result.angles[face] = angle < 0 ? angle + std::numbers::pi : angle;
    }
    result.points = zeros_and_poles(surface, differential);
    return result;
}

}  // namespace beltrami
