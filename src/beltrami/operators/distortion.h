#pragma once

#include <beltrami/base/public.h>
#include <beltrami/operators/map_derivatives.h>

namespace beltrami BELTRAMI_PUBLIC {

/// μ = ∂̄f/∂f at every sample (#S) of a map. |μ| < 1 exactly where the map keeps orientation, > 1 where it
/// is flipped; infinite where ∂f = 0 only, NaN where both derivatives vanish.
Eigen::VectorXcd beltrami_coefficient(const MapDerivatives& map);
Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Eigen::VectorXcd& map);

/// The same of a map into space (map_derivatives.h).
Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Positions& image, const Positions& normals);

/// K = (1+|μ|)/|1−|μ||: infinite at |μ| = 1, and of a turned-over face the ratio of its singular values.
double dilatation(double abs_mu);

/// k = (K−1)/(K+1), the |μ| of the dilatation K.
double k_of(double K);

/// What a map does to its source, measured by the one routine that solvers, tests and the command share.
struct Distortion {
    Eigen::VectorXcd mu;          ///< #S
    Eigen::VectorXcd face_mu;     ///< #F, the area-weighted mean of a face's samples
    Eigen::VectorXd face_abs_mu;  ///< #F, the largest |μ| of a face's samples; NaN where undefined
    double mean = 0;              ///< of |μ|, weighted by source area, over the samples where it is defined and finite
    double standard_deviation = 0;  ///< likewise
    double p99 = 0;                 ///< the value that 99 % of the source area stays below or at
    double max = 0;                 ///< largest |μ|; infinite if ∂f vanishes alone somewhere
    std::vector<int> flipped;       ///< faces with |μ| > 1 at some sample
    std::vector<int> degenerate;    ///< faces whose image has an area below 1e-14 of the image's squared diameter

    double max_dilatation() const { return dilatation(max); }
    /// The same where no face is flipped; else infinite.
    double K_max() const;
};

/// Distortion of a map by its derivatives.
Distortion distortion(const Operators& source, const MapDerivatives& map);

/// Distortion of a map to the plane given at the vertices (#V).
Distortion distortion(const Operators& source, const Eigen::VectorXcd& map);

/// Distortion of a map given by positions (#V×2 or #V×3) of the same faces.
/// @param normals as above; ignored for #V×2
Distortion distortion(const Operators& source, const Positions& image, const Positions& normals = {});

/// Distortion of the map between two meshes with the same faces. A planar image of a planar source is looked at from
/// the side from which the source's faces run counter-clockwise; any other planar image from above; an image in space
/// is judged by its own vertex normals.
/// @pre same vertices and faces, finite positions
Distortion distortion_to(const Mesh& source, const Mesh& image);

/// The same for a planar image given per face corner (#corners×2), such as texture_corners: seams are allowed.
Distortion distortion_to_corners(const Mesh& source, const Positions& corners);

/// Weighted statistics of |μ| at samples, as in Distortion.
struct MuStatistics {
    double mean, standard_deviation, p99, max;
};
MuStatistics mu_statistics(const Eigen::VectorXcd& mu, const std::vector<double>& weights);

/// μ in a frame whose real axis is turned by @p angle (radians) against the old one: μ e^{−2i·angle}.
Complex change_frame(Complex mu, double angle);

/// Coefficient of g∘f from μ_f, μ_g (at the image point, in the frame of f's image) and ∂f:
/// (μ_f + μ_g t)/(1 + conj(μ_f) μ_g t), t = conj(∂f)/∂f. Ahlfors, Lectures on quasiconformal mappings, ch. I.
Complex compose_coefficients(Complex mu_f, Complex mu_g, Complex d_z_f);

/// Coefficient, at f(z), of g∘f⁻¹ from the coefficients of f and g at z and ∂f.
Complex decompose_coefficients(Complex mu_f, Complex mu_g, Complex d_z_f);

}  // namespace beltrami
