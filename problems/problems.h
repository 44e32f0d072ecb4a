#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/mesh/mesh.h>

/// Extremal-map problems for benchmarks, the gallery and tests: data only, nothing is solved here.
namespace beltrami::bench {

/// A curve of the mesh that is to lie on a parametric line of the image.
struct FeatureCurve {
    enum class Fixed { u, v };
    std::string name;
    std::vector<int> vertices;  ///< along the curve
    Fixed fixed;                ///< the coordinate that is the same at all images
    double value;
    std::vector<Complex> images;  ///< beside vertices: places on the line by arc length, for those that pin the curve
};

/// A mesh, prescribed images, and what is known about the extremal map.
///
/// The source's boundary loops run with faces on the left; the image of the outer one is counter-clockwise, those of
/// holes are clockwise. The whole boundary is prescribed.
struct Problem {
    std::string name;
    std::string statement;  ///< what is mapped to what, one or two sentences
    Mesh mesh;
    BoundaryCondition boundary;
    std::optional<double> exact_k;            ///< of the continuous problem
    std::optional<Eigen::VectorXcd> exact;    ///< #V the extremal map of the continuous problem
    std::optional<Eigen::VectorXcd> witness;  ///< #V a piecewise linear map without flips that obeys the boundary
    /// Homotopy class as Correspondence::turns: per boundary loop the counter-clockwise turns of its image against the
    /// outer one's, 0 for the outer loop; empty: the class of the harmonic map. @ref witness, where given, lies in it.
    std::vector<int> turns = {};
    std::vector<FeatureCurve> features = {};  ///< inner curves to align (and the sides of the boundary, for sliding)
    std::vector<std::vector<int>> highlights = {};  ///< sharp edges of the source, chains of vertices, for pictures
    bool teichmuller = true;                        ///< false: the extremal map is known not to be of Teichmüller type
};

/// A problem for every edge length.
struct NamedProblem {
    std::string name;
    Problem (*make)(double edge_length);
    double edge_length;  ///< usual: a few thousand triangles
};

/// All named problems, each once, in the order of the gallery.
const std::vector<NamedProblem>& named_problems();

/// @param edge_length 0: the usual one
/// @throw Error bad_option for a name that does not exist
Problem named_problem(const std::string& name, double edge_length = 0);

// Simply connected, in the plane (problems_disk.cpp).
Problem exact_composition(double edge_length);  ///< exp(0.6(g + ½ ḡ)) on the disk, k = ½
Problem three_lobes(double edge_length);        ///< the disk's boundary around three lobes, 330 flips at the start
Problem four_points(double edge_length);        ///< four points of the circle moved, ±π/4 → ±π/8 (Fig. 7)
Problem bean(double edge_length);               ///< disk → bean with uneven speed; no known map
Problem half_plane_square(double edge_length);  ///< |z|z on the half-plane seen on the disk; not Teichmüller (Fig. 3)
Problem arrow_head_45(double edge_length);      ///< square, one corner pushed in by 0.45
Problem arrow_head_65(double edge_length);      ///< by 0.65: the corner becomes reflex
Problem l_to_square(double edge_length);
Problem notched_disk(double edge_length);  ///< disk with five slit-like notches → disk, conformal speed
Problem gear_to_disk(double edge_length);  ///< 12 teeth, conformal speed
Problem disk_to_gear(double edge_length);
Problem wedge(double edge_length);   ///< square → trapezoid with one short side (Fig. 17)
Problem sector(double edge_length);  ///< square → sector of an annulus by exp of an affine map: exact

// The three lobes on bad meshes (Fig. 16).
Problem three_lobes_jittered(double edge_length);
Problem three_lobes_graded(double edge_length);
Problem three_lobes_anisotropic(double edge_length);

// Multiply connected, in the plane (problems_holes.cpp).
Problem ring(double edge_length);                      ///< radii .5 … 1 → .3 … 1 along the radii, k = .26926
Problem annulus_turns(double edge_length, int turns);  ///< .05 … 1 → .05^1.5 … 1, with whole turns; exact
Problem annulus_stretch(double edge_length);
Problem annulus_one_turn(double edge_length);
Problem annulus_minus_one_turn(double edge_length);
Problem annulus_two_turns(double edge_length);
Problem moved_hole(double edge_length);     ///< hole moved, shrunk and turned
Problem ring_to_lobes(double edge_length);  ///< doubly connected, no known map
Problem doughnut(double edge_length);       ///< its hole widened and moved (Fig. 14)
Problem holes_27(double edge_length);

// Surfaces in space (problems_space.cpp).
Problem screw(double edge_length);         ///< annulus with a helical thread (Fig. 10)
Problem cad_part(double edge_length);      ///< sharp feature curves to be aligned (Fig. 12)
Problem curved_plate(double edge_length);  ///< multiply connected and curved (Fig. 13)
Problem pierced_ball(double edge_length);  ///< 12 pentagonal holes → disk with 11 round holes (Fig. 19)

}  // namespace beltrami::bench
