#include <beltrami/remeshing/remesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/remeshing/carried_data.h>
#include <beltrami/remeshing/feature_curves.h>
#include <beltrami/remeshing/mesh_comparison.h>
#include <beltrami/space/least_squares_map.h>
#include <beltrami/space/tangential_map.h>

namespace beltrami {

namespace {

constexpr double kNeedle = 0.999;  // |μ| of a face from which on steps begin strongly damped
constexpr double kNeedleDamping = 1e5;
constexpr int kFirstSteps = 6, kPowerSteps = 8, kRounds = 25, kStepsOfRound = 2;
constexpr double kGrowth = 4;                   // of what draws back vertices that stray
constexpr int kPatientRounds = 15;              // after which it grows faster
constexpr int kAttempts = 4, kFrozenRings = 1;  // of vertices that stay from the second attempt on
constexpr double kGain = 0.003;                 // of the mean of ψ^{p/2}: what two steps have to bring for two more
constexpr double kTolerance = 1e-3, kRoundTolerance = 1e-4;

constexpr double kDistanceFactor = 1.4;  // up to which the distance allowed is kept
// Small angles are opened towards so much more than the one below which 1 % are, some steps at a time, until so many
// times in a row it gained hardly anything.
constexpr double kOpenedBy = 3, kOpeningGain = 0.05;  // degrees
constexpr int kOpeningRounds = 45, kOpeningSteps = 2, kFutileOpenings = 3;
constexpr double kDegree = std::numbers::pi / 180;

double diagonal_of(const Mesh& mesh) {
    return (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
}

Positions points_of(const Mesh& mesh, const std::vector<int>& vertices) {
    Positions points(static_cast<Eigen::Index>(vertices.size()), 3);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        points.row(static_cast<Eigen::Index>(i)) = mesh.point(vertices[i]);
    return points;
}

/// What stays and what slides. Of faces that oppose the surface, of which nothing is known there, the vertices stay.
TargetConstraints constraints_of(const Surface& surface, const MeshTarget& target, const RemeshOptions& options) {
    const Mesh& mesh = surface.mesh;
    std::vector<std::array<int, 2>> seams;
    if (options.keep_seams) seams = seam_edges(mesh);
    const FeatureCurves features = feature_curves(mesh, surface.topology, options.feature_angle, seams);
    std::vector<char> fixed(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const int v : features.corners) fixed[v] = 1;
    for (const int f : opposed_faces(mesh, target))
        for (const int v : mesh.faces[f]) fixed[v] = 1;
    if (!options.slide_border)
        for (const auto& loop : surface.topology.boundary_loops)
            for (const int v : loop) fixed[v] = 1;
    TargetConstraints constraints;
    for (const FeatureCurves::Curve& curve : features.curves) {
        const int index = static_cast<int>(constraints.curves.size());
        constraints.curves.push_back(std::make_shared<PolylineCurve>(points_of(mesh, curve.vertices), curve.closed));
        for (const int v : curve.vertices)
            if (!fixed[v]) constraints.sliding.push_back({v, index});
    }
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (fixed[v]) constraints.fixed.push_back(v);
    return constraints;
}

/// Where a vertex has to be in units of what the mean vertex has.
Eigen::VectorXd area_factors(const Operators& operators, const Eigen::VectorXd& sizing) {
    Eigen::VectorXd factors(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) {
        double log_size = 0;
        for (const int v : operators.stencil(s)) log_size += std::log(sizing[v]) / 3;
        factors[s] = std::exp(2 * log_size);
    }
    double mean = 0;
    for (int s = 0; s < operators.sample_count(); ++s) mean += operators.weights[s] * factors[s];
    return factors * (operators.area() / mean);
}

void conclude(const Surface& surface, const MeshTarget& target, RemeshedSurface& result) {
    Mesh image = surface.mesh;
    image.positions = result.positions;
    result.distance = surface_distance(target, MeshTarget(image)).largest / diagonal_of(surface.mesh);
    result.unresolved = opposed_faces(image, target);
    result.opposed_before = opposed_faces(surface.mesh, target);
}

/// Where the start has needles, whose vertices no step must carry along.
bool has_needles(const Eigen::VectorXcd& mu) {
    return mu.size() > 0 && mu.cwiseAbs().maxCoeff() > kNeedle;
}

void warn_of_distance(const RemeshOptions& options, RemeshedSurface& result) {
    if (result.distance > kDistanceFactor * options.max_distance)
        result.warnings.push_back(
            {WarningKind::iteration_limit, "the image is up to " + std::to_string(result.distance) +
                                               " of the diagonal away from the surface, more than was allowed"});
}

void warn_of_tips(RemeshedSurface& result) {
    if (result.unresolved.empty()) return;
    const std::size_t count = result.unresolved.size();
    result.warnings.push_back({WarningKind::flipped_faces,
                               "under-resolved tips: " + std::to_string(count) +
                                   (count == 1 ? " face opposes" : " faces oppose") + " the surface (" +
                                   std::to_string(result.opposed_before.size()) + " did so before)",
                               {Things::faces, result.unresolved}});
}

/// Two steps at a time, vertices drawn back between them that have gone too far or around which faces oppose the
/// surface that did not before, until that is so nowhere and steps gain little. The best map of those that keep both is
/// the result; where there is none, the vertices that are to blame stay where they are, and all begins again.
class Rounds {
  public:
    Rounds(const Surface& surface, const Operators& reference, const MeshTarget& target, const RemeshOptions& options)
        : surface_(surface),
          reference_(reference),
          target_(target),
          options_(options),
          allowed_(options.max_distance * diagonal_of(surface.mesh)),
          opposed_before_(opposed_faces(surface.mesh, target)) {}

    /// @return vertices that are still too far away, or in faces that newly oppose the surface; none where all is kept
    std::vector<int> run(TangentialMap& map, RemeshedSurface& result) const {
        std::optional<TargetMap> best;
        std::vector<int> bad;
        double least = std::numeric_limits<double>::infinity(), last = least;
        for (; result.rounds < kRounds; ++result.rounds) {
            const double mean = mean_power(map.coefficients());
            bad = draw_back(map, best ? kGrowth : growth_in(result.rounds));
            if (bad.empty() && mean < least) {
                least = mean;
                best = map.map();
            }
            if (bad.empty() && !(mean < (1 - kGain) * last)) break;
            last = mean;
            map.relax(options_.power, kStepsOfRound, kRoundTolerance);
        }
        result.settled = best.has_value();
        if (!best) return bad;
        map.return_to(std::move(*best));
        return {};
    }

    /// Opens small angles of a map that keeps both, as long as the smallest or the one below which 1 % are grows and
    /// neither ends smaller than it began.
    void open_angles(TangentialMap& map) const {
        TargetMap best = map.map();
        const AngleStatistics first = angles(map);
        AngleStatistics most = first;
        for (int round = 0, futile = 0; round < kOpeningRounds && futile < kFutileOpenings; ++round) {
            map.open_angles((most.one_percent + kOpenedBy) * kDegree);
            map.relax(options_.power, kOpeningSteps, kRoundTolerance);
            const bool kept = draw_back(map, kGrowth).empty();
            const AngleStatistics now = angles(map);
            const bool gains = now.one_percent + now.smallest >= most.one_percent + most.smallest + kOpeningGain;
            if (!gains) ++futile;
            const bool shrinks = now.one_percent < first.one_percent || now.smallest < first.smallest;
            if (!gains || !kept || shrinks) continue;
            most = now;
            best = map.map();
            futile = 0;
        }
        map.open_angles(0);
        map.return_to(std::move(best));
    }

  private:
    AngleStatistics angles(const TangentialMap& map) const {
        Mesh image = surface_.mesh;
        image.positions = map.positions();
        return angle_statistics(image);
    }

    /// @return vertices that are too far away, or in faces that newly oppose the surface
    std::vector<int> draw_back(TangentialMap& map, double growth) const {
        std::vector<int> bad = around_newly_opposed(map);
        map.draw_back(bad);
        const std::vector<int> strayed = map.hold_within(allowed_, growth);
        bad.insert(bad.end(), strayed.begin(), strayed.end());
        return bad;
    }

    /// What vertices that stray are drawn back by more, while no map has kept the distance yet.
    static double growth_in(int round) { return round < kPatientRounds ? kGrowth : kGrowth * kGrowth * kGrowth; }

    double mean_power(const Eigen::VectorXcd& mu) const {
        double sum = 0;
        for (int s = 0; s < reference_.sample_count(); ++s) {
            const double square = std::norm(mu[s]);
            sum += reference_.weights[s] * std::pow(square / (1 - square), 0.5 * options_.power);
        }
        return sum;
    }

    /// Vertices of faces that oppose the surface and did not at the start.
    std::vector<int> around_newly_opposed(const TangentialMap& map) const {
        Mesh image = surface_.mesh;
        image.positions = map.positions();
        std::vector<int> vertices;
        for (const int f : opposed_faces(image, target_, map.points())) {
            if (std::binary_search(opposed_before_.begin(), opposed_before_.end(), f)) continue;
            vertices.insert(vertices.end(), image.faces[f].begin(), image.faces[f].end());
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        return vertices;
    }

    const Surface& surface_;
    const Operators& reference_;
    const MeshTarget& target_;
    const RemeshOptions& options_;
    double allowed_;
    std::vector<int> opposed_before_;  // ascending
};

/// Vertices within some rings of others.
void freeze_around(const Surface& surface, const std::vector<int>& vertices, std::vector<char>& frozen) {
    for (const int v : vertices) frozen[v] = 1;
    for (int ring = 0; ring < kFrozenRings; ++ring) {
        std::vector<char> wider = frozen;
        for (const auto& [a, b] : surface.topology.edges)
            if (frozen[a] || frozen[b]) wider[a] = wider[b] = 1;
        frozen = std::move(wider);
    }
}

/// The same with further vertices that stay.
TargetConstraints with_frozen(TargetConstraints constraints, const std::vector<char>& frozen) {
    std::erase_if(constraints.sliding,
                  [&](const TargetConstraints::Slide& slide) { return frozen[slide.vertex] != 0; });
    std::vector<char> fixed = frozen;
    for (const int v : constraints.fixed) fixed[v] = 1;
    constraints.fixed.clear();
    for (std::size_t v = 0; v < fixed.size(); ++v)
        if (fixed[v]) constraints.fixed.push_back(static_cast<int>(v));
    return constraints;
}

RemeshedSurface fast(const Surface& surface, const CornerElements& elements, const MeshTarget& target,
                     const TargetConstraints& constraints) {
    std::vector<char> fixed(static_cast<std::size_t>(surface.mesh.vertex_count()), 0);
    for (const int v : constraints.fixed) fixed[v] = 1;
    for (const TargetConstraints::Slide& slide : constraints.sliding) fixed[slide.vertex] = 1;
    Positions start(surface.mesh.vertex_count(), 3);
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) start.row(v) = surface.mesh.point(v);
    LeastSquaresMap problem(surface.mesh, elements, std::move(start), std::move(fixed), Preserve::normals);
    const Positions moved = problem.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
    const Target::Points points = nearest_points(target, moved);
    RemeshedSurface result;
    result.positions = positions_of(points);
    result.places = places_of(points);
    result.factorizations = problem.factorization_count();
    result.settled = true;
    conclude(surface, target, result);
    if (result.unresolved.size() > result.opposed_before.size())
        throw Error(Cause::not_solved,
                    "one linear solve folds " + std::to_string(result.unresolved.size()) +
                        (result.unresolved.size() == 1 ? " face" : " faces"),
                    "take the iteration", {Things::faces, result.unresolved});
    return result;
}

}  // namespace

void RemeshOptions::validate() const {
    if (!(power >= 2 && power <= 64)) throw Error(Cause::bad_option, "the power is not between 2 and 64");
    if (!(max_distance > 0)) throw Error(Cause::bad_option, "the distance allowed is not positive");
    if (!(even_size >= 0)) throw Error(Cause::bad_option, "the weight of the areas is negative");
    if (feature_angle && !(*feature_angle > 0 && *feature_angle < std::numbers::pi))
        throw Error(Cause::bad_option, "the angle of features is not between 0 and 180 degrees");
    if (sizing && !(sizing->array() > 0).all()) throw Error(Cause::bad_option, "a size is not positive");
}

RemeshedSurface remesh(const Surface& surface, const Positions& reference, const RemeshOptions& options) {
    options.validate();
    if (options.sizing && options.sizing->size() != surface.mesh.vertex_count())
        throw Error(Cause::bad_option, "there are " + std::to_string(options.sizing->size()) + " sizes for " +
                                           std::to_string(surface.mesh.vertex_count()) + " vertices");
    const CornerElements elements = corner_elements(surface.mesh, reference);
    const MeshTarget target(surface.mesh);
    const TargetConstraints constraints = constraints_of(surface, target, options);
    if (options.fast) return fast(surface, elements, target, constraints);

    RemeshedSurface result;
    const Rounds rounds(surface, elements.operators, target, options);
    std::vector<char> frozen(static_cast<std::size_t>(surface.mesh.vertex_count()), 0);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const TargetConstraints held = with_frozen(constraints, frozen);
        TangentialMap map(surface, elements.operators, target, held, options.even_size);
        map.set_progress(options.progress);
        if (options.sizing) map.scale_areas(area_factors(elements.operators, *options.sizing));
        if (has_needles(map.coefficients())) map.set_damping(kNeedleDamping);
        map.relax(2, kFirstSteps, kTolerance);
        if (options.power > 2) map.relax(options.power, kPowerSteps, kTolerance);
        result.rounds = 0;
        const std::vector<int> bad = rounds.run(map, result);
        if (bad.empty() && options.open_angles) rounds.open_angles(map);
        result.positions = map.positions();
        result.places = places_of(map.points());
        result.steps += map.steps();
        result.factorizations += map.factorization_count();
        if (bad.empty()) break;
        freeze_around(surface, bad, frozen);
    }
    conclude(surface, target, result);
    if (result.distance > kDistanceFactor * options.max_distance) result.settled = false;
    warn_of_distance(options, result);
    warn_of_tips(result);
    return result;
}

}  // namespace beltrami
