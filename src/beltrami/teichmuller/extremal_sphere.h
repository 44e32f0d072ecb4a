#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A vertex and the point of the unit sphere to which it is to go.
struct SphereLandmark {
    int vertex = 0;
    Eigen::Vector3d image;
    /// Infinite: the vertex goes there. Else the map minimises ½ log K + Σ weight·|place − image|².
    double weight = std::numeric_limits<double>::infinity();
};

struct ExtremalSphereOptions : IterationOptions {
    // tolerance: stop when φ changes by less than this and k by less than a tenth of it. 0: 1e-5, or, without soft
    // landmarks, once both no longer matter beside the bracket of K. anderson_window has no effect.
    ExtremalSphereOptions() { max_iterations = 40; }

    int cluster_count = 1500;  ///< quadrature points of the c-step on large meshes, at least 100
    /// #V×3 points of the unit sphere to start from instead of the conformal map; the landmarks are led from there to
    /// their images.
    std::optional<Positions> start = {};
    /// #L×3 unit vectors each: stops of the landmarks on the way, from where the best Möbius map puts them (or the
    /// start has them) along great circles to their images, which chooses the homotopy class. A row of NaN: the
    /// landmark is on its straight way.
    std::vector<Positions> waypoints = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// An extremal map to the unit sphere, and how good it is. `map` of the base is empty: the images are `positions`.
struct ExtremalSphereMap : MapResult {
    Positions positions;                 ///< #V×3 unit vectors; landmarks that are not soft are at their images
    Positions start;                     ///< #V×3 the map from which the iteration began
    QuadraticDifferential differential;  ///< with simple poles at the landmarks; zero() where the map is conformal
    Eigen::VectorXcd phi;                ///< #S its means over triangles; values at the samples of quads
    double k = 0, K = 1;                 ///< of the last c-step: estimates of k* and K*
    /// 1/I⁻ of the Reich-Strebel inequality: an estimate of a lower bound, as the atlas is conformal up to the mesh.
    double K_lower = 1;
    double K_max = 1;  ///< largest K of a face
    std::vector<Bound> bounds;
    double weighted_mean = 0, weighted_deviation = 0;  ///< of |μ| by |φ|: k and 0 of the extremal map
    int dimension = 0;                                 ///< complex, of the differentials
    double residual = 0;    ///< largest distance of a soft landmark from its image, on the sphere
    double separation = 2;  ///< least distance between two landmarks, before or after
    std::vector<Iteration> history;
};

/// The extremal (Teichmüller) map of a closed surface of genus 0 to the unit sphere among those of a homotopy class
/// that take landmarks to their images: with four and more Hamilton's iteration, with fewer the conformal map. Composed
/// with the inverse of a conformal map of another surface to the sphere it is the extremal map between the two.
///
/// The start is the conformal map, the Möbius map that brings the landmarks nearest to their images, and a flow of the
/// sphere that takes them there along great circles. The c-step has φ = q dz²/Π(z − a_i) (sphere_space.h), the f-step
/// is one step down an energy that is infinite at a flip (sphere_map_step.h), so that no face ever flips. The metric of
/// μ is the surface's own. Soft landmarks, at least four landmarks in all, move from their images by a quasi-Newton
/// method (soft_landmarks.h): the map is the extremal one for the places they come to.
/// @param on_sphere #V×3: a conformal map of the surface to the unit sphere without flipped faces, as of sphere_map()
/// @throw Error bad_mesh unless the surface is closed, of one component and genus 0; bad_option; bad_boundary for
///        landmarks that are no vertices of faces, occur twice, coincide or are closer than 1e-3 on the sphere, and
///        where the start folds; not_solved, cancelled
ExtremalSphereMap extremal_sphere_map(const Surface& source, const Positions& on_sphere,
                                      std::span<const SphereLandmark> landmarks,
                                      const ExtremalSphereOptions& options = {});

}  // namespace beltrami
