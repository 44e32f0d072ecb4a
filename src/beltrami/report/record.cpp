#include <beltrami/report/record.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

SourceRecord source_record(const Mesh& mesh) {
    return {mesh.vertex_count(), mesh.face_count(), {}};
}

SourceRecord source_record(const Mesh& mesh, const Topology& topology, double unit) {
    SourceRecord record = source_record(mesh);
    record.shape = {topology.components, topology.genus, {}};
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l) {
        const std::vector<int>& loop = topology.boundary_loops[l];
        record.shape->boundary_loops.push_back(
            {unit * topology.loop_lengths[l], static_cast<int>(loop.size()), loop[0]});
    }
    return record;
}

SourceRecord source_record(const Surface& surface, double unit) {
    return source_record(surface.mesh, surface.topology, unit);
}

MapRecord map_record(const Distortion& distortion) {
    MapRecord record;
    record.mean = distortion.mean;
    record.standard_deviation = distortion.standard_deviation;
    record.p99 = distortion.p99;
    record.max = distortion.max;
    record.flipped = static_cast<int>(distortion.flipped.size());
    record.degenerate = static_cast<int>(distortion.degenerate.size());
    if (distortion.flipped.empty()) record.K_max = distortion.max_dilatation();
    return record;
}

MapRecord map_record(const ExtremalMap& result) {
    MapRecord record = map_record(result.distortion);
    record.k = result.k;
    record.K = result.K;
    if (result.distortion.flipped.empty() || result.K_lower > 1) record.K_lower = result.K_lower;
    record.K_lower_proved = result.K_lower_proved;
    if (record.K_max && std::isfinite(result.K_max)) record.K_max = std::max(*record.K_max, result.K_max);  // of quads
    for (const Bound& bound : result.bounds)
        if (bound.kind == Bound::Kind::verified || bound.kind == Bound::Kind::moduli_upper) record.K_upper = bound.K;
    record.bounds = result.bounds;
    record.boundary_residual = result.boundary_residual;
    return record;
}

namespace {

bool is_estimate(Bound::Kind kind) {
    return kind == Bound::Kind::reich_strebel_estimate || kind == Bound::Kind::averaged_estimate;
}

}  // namespace

MapRecord map_record(const LeastMaximumMap& result) {
    MapRecord record = map_record(result.distortion);
    if (result.extremal) {
        // k, K and the attained value are those of another map; what is below K* is below every map's K.
        for (const Bound& bound : result.extremal->bounds)
            if (bound.kind != Bound::Kind::attained && !is_estimate(bound.kind)) record.bounds.push_back(bound);
        if (result.extremal->distortion.flipped.empty() || result.extremal->K_lower > 1)
            record.K_lower = result.extremal->K_lower;
        record.K_lower_proved = result.extremal->K_lower_proved;
        record.boundary_residual = result.extremal->boundary_residual;
    }
    if (record.K_max && std::isfinite(*record.K_max))
        record.bounds.push_back({Bound::Kind::attained, *record.K_max, Bound::Of::extremal,
                                 result.distortion.mu.size() == result.distortion.face_mu.size()});  // triangles
    return record;
}

SolveRecord solve_record(const ExtremalMap& result, double seconds_total) {
    return {result.iterations,
            to_string(result.termination),
            result.factorizations,
            seconds_total,
            {},
            result.folds_removed,
            result.history};
}

OntoRecord onto_record(const ExtremalMap& result, const std::string& target) {
    return {target,
            result.space,
            result.dimension,
            result.expected_dimension,
            result.dimension_gap,
            result.K_upper,
            result.loops,
            result.move,
            result.path,
            result.led,
            result.start_flips};
}

CorrespondenceRecord correspondence_record(const ExtremalMapBetween& result, const std::string& target,
                                           std::size_t pairs) {
    return {target, static_cast<int>(pairs), result.target.correspondence.partner};
}

UniformizationRecord uniformization_record(const Uniformization& result) {
    return {result.chart.outer_loop(), result.holes, result.moduli, result.module, result.chart.roundness};
}

SphereRecord sphere_record(const SphereMap& result) {
    return {
        result.method,         result.route,        result.moved,           result.ideal_vertex,
        result.residual,       result.layout_error, result.centre_distance, static_cast<int>(result.unresolved.size()),
        result.unresolved_area};
}

PeriodsRecord periods_record(const HomologyBasis& loops, const Eigen::MatrixXi& basis, const Eigen::MatrixXcd& periods,
                             double unit) {
    PeriodsRecord record{{}, basis, periods};
    for (std::size_t l = 0; l < loops.loops.size(); ++l)
        record.loops.push_back({unit * loops.lengths[l], loops.loops[l]});
    return record;
}

TorusRecord torus_record(const FlatTorus& torus) {
    const double unit = 1 / std::sqrt(torus.tau.imag());
    return {torus.tau, torus.tau_error, {unit, unit * std::abs(torus.tau)}, torus.flips};
}

MapRecord map_record(const ExtremalSphereMap& result) {
    MapRecord record = map_record(result.distortion);
    record.k = result.k;
    record.K = result.K;
    record.K_lower = result.K_lower;
    record.bounds = result.bounds;
    return record;
}

HyperbolicRecord hyperbolic_record(const HyperbolicSurface& metric, const HyperbolicDomain& domain) {
    HyperbolicRecord record;
    record.area = metric.has_boundary() ? metric.area() / 2 : metric.area();
    record.residual = metric.residual;
    record.flips = static_cast<int>(metric.unfolded.size());
    record.ptolemy_flips = static_cast<int>(metric.ptolemy.size());
    record.inverted = static_cast<int>(metric.inverted.size());
    for (std::size_t i = 0; i < domain.generators.size(); ++i)
        record.generators.push_back({domain.lengths[i], domain.generators[i].on_half_plane(), domain.paths[i]});
    record.relation = domain.relation;
    record.boundary = domain.boundary_lengths;
    return record;
}

MapRecord map_record(const LpRegistration& result) {
    MapRecord record = map_record(result.carried.distortion);
    if (!result.extremal) return record;
    record.k = result.extremal->k;
    record.K = result.extremal->K;
    record.K_lower = result.extremal->K_lower;
    record.bounds = {{Bound::Kind::reich_strebel, result.extremal->K_lower, Bound::Of::extremal, false}};
    return record;
}

MapRecord map_record(const TorusMap& result) {
    MapRecord record = map_record(result.distortion);
    record.k = result.k;
    record.K = result.K;
    record.K_lower = result.K_lower;
    record.K_upper = result.K_upper;
    return record;
}

MapRecord map_record(const HyperbolicMap& result) {
    MapRecord record = map_record(result.distortion);
    record.k = result.k;
    record.K = result.K;
    record.K_lower = result.K_lower;
    if (std::isfinite(result.K_upper))
        record.bounds = {{Bound::Kind::reich_strebel, result.K_lower, Bound::Of::extremal, false},
                         {Bound::Kind::reich_strebel_upper, result.K_upper, Bound::Of::extremal, false}};
    return record;
}

SolveRecord solve_record(const ExtremalSphereMap& result, double seconds_total) {
    return {result.iterations, to_string(result.termination), result.factorizations, seconds_total, {}, false,
            result.history};
}

SolveRecord solve_record(const TorusMap& result, double seconds_total) {
    return {result.factorizations, to_string(result.termination), result.factorizations, seconds_total, {}, false};
}

SolveRecord solve_record(const HyperbolicMap& result, double seconds_total) {
    return {result.iterations, to_string(result.termination), result.factorizations, seconds_total, {}, false,
            result.history};
}

namespace {

RegistrationRecord carried_record(const CarriedSurface& result, const std::string& target, std::size_t landmarks) {
    RegistrationRecord record;
    record.target = target;
    record.landmarks = static_cast<int>(landmarks);
    record.flipped_in_space = static_cast<int>(result.in_space.flipped.size());
    record.unresolved = static_cast<int>(result.unresolved.size());
    record.largest_distance = result.largest_distance;
    return record;
}

}  // namespace

RegistrationRecord registration_record(const SphereRegistration& result, const std::string& target,
                                       std::size_t landmarks) {
    RegistrationRecord record = carried_record(result, target, landmarks);
    record.sphere = {result.map.dimension, result.map.weighted_mean, result.map.weighted_deviation,
                     result.map.separation};
    record.inverse_k = result.inverse_k;
    return record;
}

SolveRecord solve_record(const SurfaceFlowMap& result, double seconds_total) {
    return {result.iterations, to_string(result.termination), result.factorizations, seconds_total, {}, false};
}

RegistrationRecord registration_record(const LpRegistration& result, double p, const std::string& target,
                                       std::size_t landmarks) {
    RegistrationRecord record = carried_record(result, target, landmarks);
    record.lp = {p,
                 static_cast<int>(result.source.curves.size()),
                 static_cast<int>(result.start_flipped.size()),
                 result.curve_distance,
                 {}};
    if (const auto& extremal = result.extremal) record.lp->by_phi = {extremal->mean, extremal->standard_deviation};
    return record;
}

RegistrationRecord registration_record(const OpenRegistration& result, const std::string& target,
                                       std::size_t landmarks) {
    RegistrationRecord record = carried_record(result, target, landmarks);
    record.inverse_k = result.inverse_k;
    return record;
}

RegistrationRecord registration_record(const HandleRegistration& result, const HyperbolicShape& source,
                                       const std::string& target) {
    const HyperbolicMap& map = result.map;
    RegistrationRecord record = carried_record(map, target, 0);
    const HyperbolicShape::Differentials& q = source.differentials();
    record.handles = {map.homology, result.mended,
                      RegistrationRecord::WithHandles::Hyperbolic{q.space->size(),
                                                                  map.weighted_mean,
                                                                  map.weighted_deviation,
                                                                  map.K_homology,
                                                                  map.energy,
                                                                  map.k_in_space,
                                                                  {q.kernel[q.kernel.size() - 1], q.next},
                                                                  {}}};
    if (result.search) {
        RegistrationRecord::WithHandles::Hyperbolic::Search& search = record.handles->hyperbolic->search.emplace();
        for (const ClassSearch::Reached& r : result.search->reached)
            search.reached.push_back({r.energy, r.homology_bound, r.twists, r.homology});
        search.failed = result.search->failed;
    }
    record.inverse_k = result.inverse_k;
    return record;
}

RegistrationRecord registration_record(const TorusMap& result, const std::string& target) {
    RegistrationRecord record = carried_record(result, target, 0);
    record.handles = {result.marking.transpose(), 0, {}};
    return record;
}

SolveRecord solve_record(const LeastMaximumMap& result, double seconds_total) {
    // Where rounding allows no better map, it has converged.
    const bool settled = result.fold_free && result.status != FoldFreeStatus::iteration_limit;
    const int first = result.extremal ? result.extremal->iterations : 0;
    return {first + result.iterations,
            to_string(settled ? Termination::converged : Termination::iteration_limit),
            result.factorizations,
            seconds_total,
            {},
            false};
}

CertificateRecord certificate_record(const Certification& certified, double wanted) {
    return {wanted,
            certified.result.K_lower_proved,
            certified.K_upper,
            certified.gap,
            certified.estimated_gap,
            certified.reached,
            certified.refinements,
            certified.proof_triangles,
            certified.reason};
}

CornersRecord corners_record(const ExtremalMap& result) {
    return {static_cast<int>(result.corners.size()), result.sharpest};
}

SplitRecord split_record(const SplitProblem& split, int source_vertices) {
    SplitRecord record{split.split_edges, {}};
    for (std::size_t i = 0; i < split.parents.size(); ++i) {
        std::vector<int> row{source_vertices + static_cast<int>(i)};
        for (const int parent : split.parents[i])
            if (parent >= 0) row.push_back(parent);
        record.added.push_back(std::move(row));
    }
    return record;
}

void record_findings(const ExtremalMap& result, int source_vertices, Record& record) {
    if (!result.homotopy.holes.empty()) record.homotopy = result.homotopy;
    record.corners = corners_record(result);
    record.outline = {result.in_chart, result.slack, result.noise};
    if (result.split) record.split = split_record(*result.split, source_vertices);
    append(record.warnings, result.warnings);
}

}  // namespace beltrami
