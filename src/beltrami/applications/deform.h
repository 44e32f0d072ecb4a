#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How the surface is chosen onto which a deformed one is mapped.
enum class DeformedSurface {
    automatic,   ///< the first of those below that has no folds
    thin_plate,  ///< displacements with the least Σ |Δu|²
    rigid,       ///< as rigid as possible
    uniform,     ///< the QC iteration of Gruber and Aulisa, which lets the surface free
    given,       ///< a target
};
const char* to_string(DeformedSurface surface);

/// What is made small of the map onto the surface.
enum class DeformGoal {
    /// K, by the extremal map and with bounds of it, where its differentials are known: on surfaces of genus 0 of which
    /// the whole boundary is held. Elsewhere the largest |μ|, and a warning says why.
    dilatation,
    largest,  ///< |μ| of a face: the means of ψ^{p/2}, ψ = |μ|²/(1 − |μ|²), for growing p
    /// The standard deviation of |μ|: by the QC iteration, where that has no folds and differentials would be known, or
    /// by the powers, whichever leaves less.
    spread,
};
const char* to_string(DeformGoal goal);

struct DeformOptions {
    DeformedSurface surface = DeformedSurface::automatic;
    DeformGoal goal = DeformGoal::largest;
    /// ψ^{p/2} is made small for p = 2, 4, 8 … up to this: small ones for the mean, large ones for the largest |μ|.
    double last_power = 32;
    int steps_of_power = 12;
    double tolerance = 3e-3;  ///< part by which a step has to lower the energy
    Progress progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct Deformation {
    Positions positions;            ///< #V×3
    Mesh surface;                   ///< on which they are; where a target is no mesh, that which it began with
    std::vector<MeshPoint> places;  ///< #V: where on it; empty where a target is no mesh
    DeformedSurface kind = DeformedSurface::thin_plate;
    DeformGoal goal = DeformGoal::largest;  ///< that was reached
    std::optional<ExtremalMap> extremal;    ///< of the goal dilatation: the map in the plane, its k and its bounds
    Distortion distortion;                  ///< of the map
    /// Of its flipped faces those which no map onto the surface opens, as the handles' places alone turn a triangle
    /// over, or a quad's at a corner.
    std::vector<int> forced;
    Distortion of_surface;                  ///< of the surface's own vertices, with which it began
    double area_ratio = 1;                  ///< of the surface to the source
    std::vector<std::array<int, 2>> folds;  ///< edges at which the result folds and the source does not
    int steps = 0, factorizations = 0;
    bool settled = false;  ///< what is made small hardly changed in the end
    bool warm = false;     ///< it went on from the last one
    Warnings warnings;
};

/// Deforms a surface in space by handles: vertices with prescribed places, boundary loops or any others. Which surface
/// the result lies on is chosen first, since of all surfaces none is extremal (left free it collapses); the map onto it
/// is then the one of small dilatation that folds nowhere, by steps along it (space/tangential_map.h). It is extremal
/// for that surface only. Boundary vertices that are no handles slide along the boundary.
///
///     DeformSolver solver(surface, handles);
///     Deformation first = solver.solve(places);   // again and again: goes on from the last
class DeformSolver {
  public:
    /// @param source  kept by reference
    /// @param handles different vertices, at least one on every component
    /// @throw Error bad_boundary, bad_option
    DeformSolver(const Surface& source, std::vector<int> handles, DeformOptions options = {});
    ~DeformSolver();

    /// @param places #handles×3
    /// @throw Error bad_boundary if every surface has folds, naming the edges of that with the fewest; bad_option,
    ///        not_solved, cancelled
    Deformation solve(const Positions& places);
    /// Onto a given surface or plane; handles go to its nearest points, and so does, to begin with, one of the surfaces
    /// above, the first that does not fold there. What begins folded in a plane is unfolded.
    /// @throw Error not_solved naming faces that fold wherever it begins
    Deformation solve_onto(const Target& target, const Positions& places);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace beltrami
