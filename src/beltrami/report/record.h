#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/charts/uniformization.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/forms/period_matrix.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/registration/register_curves.h>
#include <beltrami/registration/register_handles.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/report/deform_record.h>
#include <beltrami/report/grid_record.h>
#include <beltrami/report/registration_record.h>
#include <beltrami/report/remesh_record.h>
#include <beltrami/teichmuller/certify.h>
#include <beltrami/teichmuller/distance.h>
#include <beltrami/teichmuller/extremal_between.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/least_maximum.h>
#include <beltrami/teichmuller/torus_map.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What was read. Topology is absent for a mesh on which it is not defined.
struct SourceRecord {
    int vertices = 0, faces = 0;
    struct Loop {
        double length;
        int vertices, first_vertex;
    };
    struct Shape {
        int components, genus;
        std::vector<Loop> boundary_loops;  ///< loop 0 first
    };
    std::optional<Shape> shape;
};

/// What a map does. Absent numbers do not apply; NaN and infinity become null in JSON.
struct MapRecord {
    std::optional<double> k, K, K_lower, K_lower_proved, K_upper, K_max;
    std::vector<Bound> bounds;
    double mean = 0, standard_deviation = 0, p99 = 0, max = 0;
    int flipped = 0, degenerate = 0;
    std::optional<double> boundary_residual;
};

/// How it was found.
struct SolveRecord {
    int iterations = 0;
    std::string termination;
    int factorizations = 0;
    double seconds_total = 0;
    std::optional<double> seconds_harmonic;
    bool folds_removed = false;           ///< of the extremal map
    std::vector<Iteration> history = {};  ///< of the extremal map; empty: none
};

/// Corners and kinks of source and boundary values.
struct CornersRecord {
    int count = 0;
    std::optional<BoundaryCorner> sharpest;  ///< the one with the largest safe_bound above 1
};

/// What the plane of the chart, moved boundary points and the noise of the outline have to do with the map.
struct OutlineRecord {
    std::optional<InChart> in_chart;
    std::optional<SlackReport> slack;
    std::optional<NoiseCost> noise;
};

/// The mesh that was mapped, where edges of the source had to be split.
struct SplitRecord {
    int edges = 0;
    std::vector<std::vector<int>> added;  ///< each added vertex, then the vertices of the source whose mean it is
};

/// What minimising the largest |μ| has reached.
struct LeastMaximumRecord {
    double power = 0;
    double before = 0, after = 0;  ///< largest |μ| of the start and of the map
};

/// What a wanted gap between K_upper and K_lower_proved has come to (certify.h).
struct CertificateRecord {
    double wanted = 0;
    double K_lower_proved = 1, K_upper = 1;  ///< infinite: nothing is proved from above
    double gap = 0;                          ///< K_upper/K_lower_proved − 1
    double estimated_gap = 0;                ///< K/K_lower − 1
    bool reached = false;                    ///< proved
    int refinements = 0, proof_triangles = 0;
    std::string reason;
};

/// A map whose boundary slides onto a target.
struct OntoRecord {
    std::string target;  ///< its file
    ExtremalOptions::Space space = ExtremalOptions::Space::laurent;
    int dimension = 0, expected_dimension = 0;
    double gap = 0;  ///< how clearly the dimension was told
    double K_upper = 1;
    std::vector<LoopOnto> loops;
    DiskMoebius move;
    std::vector<Waypoint> path;
    bool led = false;
    int start_flips = 0;
};

/// A map onto a surface on whose boundary that of the source is prescribed.
struct CorrespondenceRecord {
    std::string target;  ///< its file
    int pairs = 0;
    std::vector<int> partner;  ///< of every boundary loop of the source, the loop of the target
};

/// A surface on its canonical domain.
struct UniformizationRecord {
    int outer_loop = 0;
    std::vector<RoundHole> holes;  ///< the one around 0 first
    std::vector<double> moduli;
    std::optional<double> module;  ///< of a ring
    double roundness = 0;
};

/// A closed surface on the sphere.
struct SphereRecord {
    SphereMethod method = SphereMethod::conformal_equivalence;
    SphereRoute route = SphereRoute::direct;
    int moved = 0;
    std::optional<int> ideal_vertex;
    double residual = 0, layout_error = 0, centre_distance = 0;
    int unresolved = 0;
    double unresolved_area = 0;
};

/// The loops of a surface with handles, and the periods of a closed one.
struct PeriodsRecord {
    struct Loop {
        double length;
        std::vector<int> vertices;
    };
    std::vector<Loop> loops;
    Eigen::MatrixXi basis;     ///< empty, or #loops×2g: a_1 … a_g, b_1 … b_g in terms of the loops
    Eigen::MatrixXcd periods;  ///< empty, or g×g
};

/// A closed surface of genus 1 on the plane modulo a lattice.
struct TorusRecord {
    Complex tau;
    double tau_error = 0;
    std::array<double, 2> lengths{};  ///< of a and b on the flat torus of area 1
    int flips = 0;                    ///< of edges to the intrinsic Delaunay triangulation
};

/// A surface with its metric of curvature −1.
struct HyperbolicRecord {
    double area = 0;      ///< −2πχ
    double residual = 0;  ///< largest angle defect, radians
    int flips = 0;        ///< of edges to the intrinsic Delaunay triangulation
    int ptolemy_flips = 0;
    int inverted = 0;  ///< faces whose geodesic triangle runs the other way
    struct Generator {
        double length;           ///< of the closed geodesic
        Eigen::Matrix2d matrix;  ///< on the upper half-plane
        std::vector<int> vertices;
    };
    std::vector<Generator> generators;
    double relation = 0;           ///< how far their relation is from the identity
    std::vector<double> boundary;  ///< lengths of the boundary loops, which are closed geodesics
};

/// A map with a prescribed coefficient.
struct FlowRecord {
    std::string coefficient;            ///< its file
    std::optional<std::string> target;  ///< its file, where the boundary slides
    CoefficientError error;
    bool fits = true;
    std::vector<LoopOnto> loops;  ///< where the boundary slides
};

/// A map along a surface in space, with a prescribed coefficient or of least Lᵖ norm.
struct SurfaceFlowRecord {
    std::string target;                      ///< its file or name
    std::optional<std::string> coefficient;  ///< its file
    std::optional<double> p;                 ///< else of the norm, and by what it counts
    std::string weight;
    std::string start;          ///< where it began: identity, conformal, lattice, or a file
    int held = 0, sliding = 0;  ///< vertices
    CoefficientError error;     ///< from the coefficient, or from 0
    bool fits = true;
    std::vector<SurfaceFlowIteration> history;
};

/// Distances of some shapes, and their clusters.
struct DistancesRecord {
    std::vector<std::string> shapes;
    DistanceMatrix matrix;
    std::vector<Merge> merges;
    std::vector<Complex> tau = {};                    ///< of tori, reduced
    std::vector<TorusDistances::Pair> markings = {};  ///< of every two tori: the one in which they are nearest
};

/// One line of a comparison.
struct MethodRecord {
    std::string method;
    MapRecord map;
    SolveRecord solve;
};

/// A component that was mapped by itself.
struct ComponentRecord {
    int first_face = 0, faces = 0;  ///< of the source
    MapRecord map;
    SolveRecord solve;
};

/// The record of one command, as docs/json.md describes it.
struct Record {
    std::string command;
    SourceRecord source;
    std::optional<MapRecord> map;
    std::optional<SolveRecord> solve;
    std::optional<HomotopyClass> homotopy;  ///< of the map, where there are holes
    std::optional<CornersRecord> corners;
    OutlineRecord outline;
    std::optional<SplitRecord> split;
    std::optional<CertificateRecord> certificate;
    std::optional<LeastMaximumRecord> least_maximum;
    std::optional<OntoRecord> onto;
    std::optional<CorrespondenceRecord> correspondence;
    std::optional<UniformizationRecord> uniformization;
    std::optional<SphereRecord> sphere;
    std::optional<PeriodsRecord> periods;
    std::optional<TorusRecord> torus;
    std::optional<HyperbolicRecord> hyperbolic;
    std::optional<RegistrationRecord> registration;
    std::optional<RemeshRecord> remesh;
    std::optional<DeformRecord> deform;
    std::optional<FlowRecord> flow;
    std::optional<SurfaceFlowRecord> surface_flow;
    std::optional<GridRecord> grid;
    std::optional<DistancesRecord> distances;
    std::vector<MethodRecord> comparison;
    std::vector<ComponentRecord> components;
    Warnings warnings;
};

/// @param unit of the mesh's positions, in the file's
SourceRecord source_record(const Mesh& mesh);
SourceRecord source_record(const Mesh& mesh, const Topology& topology, double unit = 1);
SourceRecord source_record(const Surface& surface, double unit = 1);
MapRecord map_record(const Distortion& distortion);
MapRecord map_record(const ExtremalMap& result);
/// Dilatation of the map itself; the lower bounds are those of the extremal map of its class.
MapRecord map_record(const LeastMaximumMap& result);
SolveRecord solve_record(const ExtremalMap& result, double seconds_total);
CertificateRecord certificate_record(const Certification& certified, double wanted);
OntoRecord onto_record(const ExtremalMap& result, const std::string& target);
SolveRecord solve_record(const LeastMaximumMap& result, double seconds_total);
CorrespondenceRecord correspondence_record(const ExtremalMapBetween& result, const std::string& target,
                                           std::size_t pairs);
UniformizationRecord uniformization_record(const Uniformization& result);
SphereRecord sphere_record(const SphereMap& result);
/// @param unit of the positions
PeriodsRecord periods_record(const HomologyBasis& loops, const Eigen::MatrixXi& basis, const Eigen::MatrixXcd& periods,
                             double unit = 1);
TorusRecord torus_record(const FlatTorus& torus);
HyperbolicRecord hyperbolic_record(const HyperbolicSurface& metric, const HyperbolicDomain& domain);
MapRecord map_record(const ExtremalSphereMap& result);
MapRecord map_record(const LpRegistration& result);
MapRecord map_record(const TorusMap& result);
MapRecord map_record(const HyperbolicMap& result);
SolveRecord solve_record(const ExtremalSphereMap& result, double seconds_total);
SolveRecord solve_record(const TorusMap& result, double seconds_total);
SolveRecord solve_record(const HyperbolicMap& result, double seconds_total);
RegistrationRecord registration_record(const SphereRegistration& result, const std::string& target,
                                       std::size_t landmarks);
SolveRecord solve_record(const SurfaceFlowMap& result, double seconds_total);
RegistrationRecord registration_record(const LpRegistration& result, double p, const std::string& target,
                                       std::size_t landmarks);
RegistrationRecord registration_record(const OpenRegistration& result, const std::string& target,
                                       std::size_t landmarks);
/// @param source of the map
RegistrationRecord registration_record(const HandleRegistration& result, const HyperbolicShape& source,
                                       const std::string& target);
RegistrationRecord registration_record(const TorusMap& result, const std::string& target);
CornersRecord corners_record(const ExtremalMap& result);
/// @param source_vertices number of vertices before the split
SplitRecord split_record(const SplitProblem& split, int source_vertices);
/// What an extremal map says beyond its numbers: class, corners, outline, split and warnings.
/// @param source_vertices number of vertices before the split
void record_findings(const ExtremalMap& result, int source_vertices, Record& record);

}  // namespace beltrami
