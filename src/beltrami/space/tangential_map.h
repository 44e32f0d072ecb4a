#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/constraints/target_constraints.h>
#include <beltrami/linear/element_system.h>
#include <beltrami/solve/target_energy.h>
#include <beltrami/solve/target_motion.h>
#include <beltrami/space/corner_angles.h>
#include <beltrami/space/surface_gap.h>

namespace beltrami {

/// A map of a reference metric onto a target whose vertices move along it until its shapes are as the reference wants
/// them. No face folds on the way:
///
///     F = Σ W ψ^{p/2} + λ Σ W (log J/J₀)² + Σ_v κ_v (P_v − X_v)ᵀ A_v (P_v − X_v)/h_v² / #V
///
/// with ψ of BarrierEnergy, J the area of the image per area of the reference and J₀ that at the start, X_v and P_v
/// where a vertex began and is, A_v the mean of n nᵀ over the faces around it at the start, weighted by angles, h_v²
/// its area there: free in the faces' planes and along ridges. κ_v is 0 until hold_within() raises it. Steps are those
/// of Gauss and Newton with Levenberg's and Marquardt's damping by the motion in units of h_v.
///
/// A face's orientation is judged by the normals of the target at its vertices. Where these come to say nothing, at
/// cusps, the face is followed by its own normal from then on.
class TangentialMap {
  public:
    /// @param start     a mesh whose vertices are on the target, where the map begins; no face of it folds. Kept by
    ///                  reference, as the rest is
    /// @param reference samples of the faces of @p start with three vertices each (corner_elements.h)
    /// @param even_size λ
    TangentialMap(const Surface& start, const Operators& reference, const Target& target,
                  const TargetConstraints& constraints, double even_size);

    /// Takes steps for a power p until one lowers F by a smaller part than a tolerance, or none does.
    /// @return how many were taken
    /// @throw Error not_solved if the start folds; cancelled
    int relax(double power, int max_steps, double tolerance);

    /// The coefficient that the map ought to have (#S, in the reference's frames, below 1) instead of 0: ψ is then that
    /// of the distance from it.
    void set_wanted(Eigen::VectorXcd coefficient) { wanted_ = std::move(coefficient); }
    /// How strongly steps are damped at first: 1; for needles 1e5.
    void set_damping(double damping) { damping_ = damping; }
    /// Adds to F what opens small angles of the faces: the mean over them of the square of what they lack, in units of
    /// a degree.
    /// @param least radians, of which angles ought to have at least so many; 0: none
    void open_angles(double least) { least_angle_ = least; }
    /// What J₀ is multiplied by (#S), for faces that ought to grow or shrink.
    void scale_areas(const Eigen::VectorXd& factors);
    /// Told of every step, with the mean of ψ^{p/2}.
    void set_progress(Progress progress) { progress_ = std::move(progress); }

    /// Raises κ where start and image are farther apart than a distance (surface_gap.h).
    /// @param growth what κ is multiplied by
    /// @return these vertices, ascending
    std::vector<int> hold_within(double distance, double growth = 4);
    /// Raises κ of vertices, and draws them in every direction, not only off their faces' planes.
    void draw_back(std::span<const int> vertices);

    /// Where the map is, and back to where it was.
    const TargetMap& map() const { return map_; }
    void return_to(TargetMap map);

    Positions positions() const { return positions_of(map_.points); }
    const Target::Points& points() const { return map_.points; }
    /// μ of the samples (#S).
    Eigen::VectorXcd coefficients() const;
    /// Samples that fold.
    std::vector<int> folded() const;
    int steps() const { return steps_; }
    int factorization_count() const { return system_.factorization_count(); }

  private:
    ImageFrame frame(int sample, const Positions& points, const Positions& normals) const;
    double value(const BarrierEnergy& energy, const TargetMap& map) const;
    double drawn_back(const Positions& points) const;
    void follow_cusps();
    void set_quadrics(const Mesh& start);
    void assemble(const BarrierEnergy& energy, const std::vector<TargetMotion::Directions>& ways);
    void assemble_vertices(double unit, const std::vector<TargetMotion::Directions>& ways);
    int face_corners(int sample) const;
    double lacking_angles(const Positions& points) const;
    void assemble_angles(const std::vector<TargetMotion::Directions>& ways);
    void assemble_samples(const BarrierEnergy& energy, const std::vector<TargetMotion::Directions>& ways);
    void equilibrate(std::vector<TargetMotion::Directions>& ways) const;
    Positions direction(const BarrierEnergy& energy);
    struct Taken {
        double length = 0, fallen = 0;
    };
    Taken step(BarrierEnergy& energy);
    void hold_blocked(const TargetMap& trial);
    void damp(double length);

    const Surface& start_;
    const Operators& operators_;
    const Target& target_;
    TargetMotion motion_;
    TargetMap map_;
    double even_size_, damping_ = 1, least_angle_ = 0;
    Progress progress_;
    std::vector<double> weights_;  // #S, of sum 1
    Eigen::VectorXcd wanted_;      // #S
    Eigen::VectorXd area_;         // #S J₀
    std::vector<char> cusp_;       // #S
    Positions own_normal_;         // #S×3 of cusps
    Eigen::VectorXd stiffness_;    // #V κ
    Eigen::VectorXd size_;         // #V h
    std::vector<Eigen::Matrix3d> quadric_;
    std::unique_ptr<SurfaceGap> gap_;  // once it is asked for
    std::vector<int> place_;           // #V among those that move, −1 elsewhere
    ElementSystem system_;
    Eigen::VectorXd gradient_;
    int steps_ = 0;
};

}  // namespace beltrami
