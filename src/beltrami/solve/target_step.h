#pragma once

#include <optional>
#include <vector>

#include <beltrami/linear/element_system.h>
#include <beltrami/solve/target_energy.h>
#include <beltrami/solve/target_motion.h>

namespace beltrami {

/// Gauss-Newton steps of a map along its target: every vertex has up to two unknowns, in units of the size of its
/// smallest face, so that limbs of any size count alike. A step is halved until it lowers the energy and flips no more
/// samples. After one that had to be cut short the samples that would have changed by more than the energy's model
/// reaches are made stiffer, each as far as it went too far, and the vertices of others that it would have flipped are
/// held, both for some steps: a needle that is about to flip then holds up itself and not the others. Vertices of faces
/// that cut through the target and would come to its other side stay where they are, for some steps too. Where the
/// energy tells no reach, the step is damped as Levenberg and Marquardt do.
class TargetStep {
  public:
    /// @param operators of the source; kept by reference as motion is
    TargetStep(const Operators& operators, const TargetMotion& motion);

    struct Taken {
        double length = 0;    ///< part of the step that was taken; 0: none would do
        double movement = 0;  ///< largest of a vertex, in the target's units
        double wanted = 0;    ///< the same of the whole step
        double energy = 0;    ///< after it
        double fallen = 0;    ///< by which part the energy fell
        bool damped = false;  ///< the step was shortened in some directions: by damping, or where samples were stiff
    };
    /// Takes one step, or none where faces have collapsed so far that its system cannot be solved.
    /// @param largest motion of a vertex
    Taken step(TargetEnergy& energy, TargetMap& map, double largest);

    int factorization_count() const { return system_.factorization_count(); }

  private:
    struct Height {
        double energy = 0;
        int flips = 0;
    };
    Height height(const TargetEnergy& energy, const TargetMap& map) const;
    std::optional<Positions> direction(const TargetEnergy& energy, const TargetMap& map);
    void assemble(const TargetEnergy& energy, const TargetMap& map, const std::vector<TargetMotion::Directions>& ways);
    bool put_to_rest(const TargetEnergy& energy, const TargetMap& from, const TargetMap& rejected, Positions& motion);
    bool drags() const;
    void damp(double length);
    void stiffen(const TargetEnergy& energy, const TargetMap& from, const Positions& motion);
    void hold_flipped(const TargetMap& from, const TargetMap& rejected);

    const Operators& operators_;
    const TargetMotion& motion_;
    std::vector<int> place_;  ///< #V among the vertices that move, −1 elsewhere
    ElementSystem system_;
    Eigen::VectorXd gradient_;
    Eigen::VectorXd stiffness_;  ///< #S, at least 1: by what the second derivatives of samples are multiplied
    Eigen::VectorXd hold_;       ///< #V, of the diagonal what is added to it
    double damping_ = 0;         ///< the same of all vertices
};

/// Samples whose image is flipped.
int flipped_samples(const Operators& operators, const TargetMap& map);

}  // namespace beltrami
