#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace beltrami {

/// A surface carried onto another one.
struct RegistrationRecord {
    std::string target;  ///< its file
    int landmarks = 0;
    /// Of closed surfaces.
    struct OnSphere {
        int dimension = 0;                                 ///< of the differentials: complex, with a boundary real
        double weighted_mean = 0, weighted_deviation = 0;  ///< of |μ| by |φ|
        double separation = 0;                             ///< least distance of two landmarks on the conformal spheres
    };
    std::optional<OnSphere> sphere;
    /// Of least Lᵖ maps, and of those of least dilatation that start from them.
    struct LeastLp {
        double p = 2;
        int curves = 0, start_flipped = 0;  ///< faces that the start had flipped
        double curve_distance = 0;          ///< largest of a vertex of a curve from its partner, in the target's units
        /// Mean and deviation of |μ| by |φ|, where the map is that of least dilatation.
        std::optional<std::array<double, 2>> by_phi;
    };
    std::optional<LeastLp> lp;
    /// Of closed surfaces with handles.
    struct WithHandles {
        /// #loops of the source × those of the target: coefficients of the images in these.
        Eigen::MatrixXi homology;
        int mended = 0;  ///< faces around which nearest points did not close up
        /// Of genus 2 and more.
        struct Hyperbolic {
            int dimension = 0;                                 ///< complex, of the differentials
            double weighted_mean = 0, weighted_deviation = 0;  ///< of |μ| by |φ|
            double homology_bound = 1;                         ///< of K, from the energies of harmonic forms
            double energy = 0;                                 ///< of the harmonic map of the class
            double k_in_space = 0;                             ///< of the straight faces
            std::array<double, 2> eigenvalues{};               ///< the largest of the kernel, and the next one
            /// Where the class was sought: what was reached, by energy, and starts that failed.
            struct Search {
                struct Reached {
                    double energy = 0, homology_bound = 1;
                    int twists = 0;
                    Eigen::MatrixXi homology;
                };
                std::vector<Reached> reached;
                int failed = 0;
            };
            std::optional<Search> search;
        };
        std::optional<Hyperbolic> hyperbolic;
    };
    std::optional<WithHandles> handles;
    int flipped_in_space = 0;  ///< straight faces between the places
    int unresolved = 0;        ///< faces on which the mesh does not resolve the map
    std::optional<double> inverse_k;
    std::optional<double> largest_distance;  ///< of soft landmarks from their places, in the target's units
};

}  // namespace beltrami
