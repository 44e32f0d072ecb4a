#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/base/complex.h>
#include <beltrami/flow/beltrami_flow.h>

namespace beltrami {

/// Sums up CoefficientError over samples, whatever the target.
class CoefficientErrorSum {
  public:
    /// A sample with weight, ∂f, ∂̄f and the coefficient that is wanted of it.
    void add(double weight, Complex dz, Complex dzbar, Complex mu) {
        const double difference = std::abs(dzbar / dz - mu);
        if (std::isfinite(difference)) {
            squares_ += weight * difference * difference;
            area_ += weight;
            error_.sup = std::max(error_.sup, difference);
        } else {
            error_.sup = std::numeric_limits<double>::infinity();
        }
        residual_ += weight * std::norm(dzbar - mu * dz);
        whole_ += weight * std::norm(dz);
    }

    /// @param smooth the sum of the squares of the residual's mean around vertices
    CoefficientError error(double smooth) const {
        CoefficientError result = error_;
        result.l2 = area_ > 0 ? std::sqrt(squares_ / area_) : 0.0;
        result.residual = std::sqrt(residual_ / whole_);
        result.misfit = std::sqrt(smooth / whole_);
        return result;
    }

  private:
    CoefficientError error_;
    double squares_ = 0, area_ = 0, residual_ = 0, whole_ = 0;
};

}  // namespace beltrami
