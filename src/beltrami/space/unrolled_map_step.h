#pragma once

#include <beltrami/solve/map_step.h>
#include <beltrami/space/unrolled_problem.h>

namespace beltrami {

/// The f-step of maps to a surface that is the plane rolled up: as far towards the least-squares map with the given
/// coefficient (UnrolledProblem) as the energy of BarrierEnergy falls, so that no sample flips that was not; where it
/// does not fall that way, a Gauss-Newton step of this energy. Samples count by their part of ∫|φ|, and in any case by
/// a little of their area: where φ vanishes faces would be left to flip.
class UnrolledMapStep final : public MapStep {
  public:
    /// @param source, elements kept by reference; see UnrolledProblem for the rest
    UnrolledMapStep(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                    const std::vector<char>& fixed);

    const Eigen::VectorXcd& map() const { return problem_.map(); }  ///< #V unrolled
    /// How much of its last step was taken; 0: none lowered the energy.
    double last_length() const { return last_length_; }
    int factorization_count() const { return problem_.factorization_count(); }

    void weigh(const Eigen::VectorXcd& phi) override;
    void solve(const Eigen::VectorXcd& nu, double tolerance) override;
    MapDerivatives derivatives() const override { return problem_.derivatives(); }
    std::any snapshot() const override { return problem_.map(); }
    void restore(const std::any& snapshot) override {
        problem_.set_map(std::any_cast<const Eigen::VectorXcd&>(snapshot));
    }

  private:
    /// Samples that are flipped, and the energy of the others.
    struct Height {
        int flipped = 0;
        double energy = 0;
        bool operator<(const Height& other) const {
            return flipped < other.flipped || (flipped == other.flipped && energy < other.energy);
        }
    };
    Height height(const BarrierEnergy& energy) const;
    double go(const Eigen::VectorXcd& from, const Eigen::VectorXcd& way, const BarrierEnergy& energy,
              const Height& before);

    const std::vector<double>& areas_;
    UnrolledProblem problem_;
    std::vector<double> weights_;
    double last_length_ = 1;
};

}  // namespace beltrami
