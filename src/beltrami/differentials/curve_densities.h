#pragma once

#include <vector>

#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// Cauchy integrals (1/2πi) ∫ ρ(t)/(t − z) dt over a polygonal curve: functions that are holomorphic off the curve and
/// jump by ρ across it, from its right to its left side. The densities ρ are linear between some nodes, as functions of
/// the length along the curve: hat functions, finer towards ends of the curve, where ρ may behave like s^(−1/2). They
/// come in levels; each halves the gaps of the one before, down to a few points of the curve.
///
/// On a curve whose jump is to be real, ρ is a real multiple of conj(τ)², τ the curve's unit tangent, so that ρ dz² is
/// real along it. Beyond the domain, where a curve goes on, any jump will do.
class CurveDensities {
  public:
    explicit CurveDensities(const Singularities::Curve& curve);

    int size() const { return static_cast<int>(densities_.cols()); }
    int levels() const { return static_cast<int>(first_of_level_.size()) - 1; }
    /// Number of functions up to a level, counted from 0, and including it.
    int size_up_to(int level) const { return first_of_level_[level + 1]; }
    /// Whether a function may have real coefficients only.
    bool real(int function) const { return real_[function] != 0; }
    /// #points × size() values of the densities at the points of the curve.
    const Eigen::MatrixXcd& densities() const { return densities_; }

    /// #z × #points weights: the value at z of the integral is that of the row with ρ at the curve's points.
    Eigen::MatrixXcd weights(const Eigen::Ref<const Eigen::VectorXcd>& z) const;
    /// The integral of one density, given at the curve's points.
    Eigen::VectorXcd integral(const Eigen::Ref<const Eigen::VectorXcd>& z, const Eigen::VectorXcd& density) const;

  private:
    void add(const std::vector<int>& nodes, std::vector<char>& known);

    Singularities::Curve curve_;
    std::vector<Complex> tangents_;
    std::vector<double> lengths_;  // along the curve
    Eigen::MatrixXcd densities_;
    std::vector<char> real_;
    std::vector<int> first_of_level_;
};

}  // namespace beltrami
