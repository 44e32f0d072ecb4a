#pragma once

#include <optional>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/operators/surface.h>
#include <beltrami/targets/mesh_target.h>

namespace beltrami BELTRAMI_PUBLIC {

struct RemeshOptions {
    /// What is made small is the mean of ψ^{p/2}, ψ = |μ|²/(1−|μ|²): 2 the mean, larger ones the worst faces.
    double power = 4;
    /// How far image and surface may be apart, of the diagonal of the box around it. Kept up to a factor of 1.4.
    double max_distance = 0.003;
    double even_size = 0.03;              ///< weight of keeping the faces' areas
    std::optional<double> feature_angle;  ///< radians; edges with sharper ones stay in their curves
    bool slide_border = true;             ///< else vertices of the border stay
    /// Vertices on seams of the mesh's texture coordinates slide along these, so that the texture can be carried along
    /// (carried_data.h); else they move freely.
    bool keep_seams = true;
    /// #V: by what edges at the vertices ought to be longer (where above the mean) or shorter than they are; empty: as
    /// they are. Takes even_size to be large: 1.
    std::optional<Eigen::VectorXd> sizing;
    /// Then the smallest angles are opened further as long as the one below which 1 % are grows: the mean deviation
    /// from regular faces, and the sizes of |μ|, may become worse.
    bool open_angles = false;
    bool fast = false;  ///< one linear solve and the nearest points instead: a preview
    Progress progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct RemeshedSurface {
    Positions positions;            ///< #V×3, on the surface
    std::vector<MeshPoint> places;  ///< #V: where that is
    double distance = 0;            ///< the largest between image and surface, of the diagonal
    int rounds = 0, steps = 0, factorizations = 0;
    bool settled = false;         ///< the distance was kept, up to its factor, before the rounds were over
    std::vector<int> unresolved;  ///< faces whose normals oppose the surface's at the end
    std::vector<int> opposed_before;
    Warnings warnings;
};

/// Moves the vertices of a mesh along its own surface until its faces have the shapes of a reference as nearly as they
/// can: the connectivity stays, and with it whatever is attached to vertices and faces. The map from the reference
/// metric onto the surface itself that makes the mean of ψ^{p/2} small, found by steps on which no face folds
/// (space/tangential_map.h); borders and features slide along themselves, their corners stay.
/// @param reference #corners×2 (reference_shapes.h)
/// @throw Error bad_option, bad_mesh, not_solved, cancelled
RemeshedSurface remesh(const Surface& surface, const Positions& reference, const RemeshOptions& options = {});

}  // namespace beltrami
