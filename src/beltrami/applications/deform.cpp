#include <beltrami/applications/deform.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include <beltrami/applications/handled_surface.h>
#include <beltrami/applications/held_maps.h>
#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/remeshing/feature_curves.h>
#include <beltrami/remeshing/mesh_comparison.h>
#include <beltrami/space/tangential_map.h>
#include <beltrami/space/uniform_map.h>
#include <beltrami/space/unrolled_map.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/teichmuller/extremal_unrolled.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr double kDamping = 0.01;
constexpr double kFarAway = 1e-2;  // of a handle's place from a target, of the root of the source's area
constexpr int kUniformSteps = 40, kDifferentialSteps = 30;
constexpr double kDifferentialTolerance = 1e-3;

std::string counted_faces(std::size_t count) {
    return counted(count, "face folds", "faces fold");
}

Mesh with_positions(const Mesh& mesh, Positions positions) {
    Mesh result;
    result.positions = std::move(positions);
    result.faces = mesh.faces;
    return result;
}

}  // namespace

struct DeformSolver::Parts {
    const Surface& source;
    std::vector<int> handles;
    DeformOptions options;
    CornerElements elements;
    HandledSurface surfaces;
    HeldMaps maps;
    std::vector<MeshPoint> last;  // of the result before

    Parts(const Surface& surface, std::vector<int> vertices, DeformOptions given)
        : source(surface),
          handles(std::move(vertices)),
          options(std::move(given)),
          elements(corner_elements(surface.mesh)),
          surfaces(surface, handles),
          maps(surface, handles) {}

    Positions by_uniform_map(const Positions& places) const {
        Positions prescribed = Positions::Zero(source.mesh.vertex_count(), 3);
        std::vector<char> fixed(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
        for (std::size_t i = 0; i < handles.size(); ++i) {
            fixed[handles[i]] = 1;
            prescribed.row(handles[i]) = places.row(static_cast<Eigen::Index>(i));
        }
        LeastSquaresMap problem(source.mesh, elements, std::move(prescribed), std::move(fixed), Preserve::nothing);
        return uniform_map(problem, source.mesh).map;
    }

    Positions surface_of(DeformedSurface kind, const Positions& places) const {
        if (kind == DeformedSurface::uniform) return by_uniform_map(places);
        Positions plate = surfaces.thin_plate(places);
        return kind == DeformedSurface::rigid ? surfaces.as_rigid_as_possible(places, std::move(plate)) : plate;
    }

    /// The surface, and which it is.
    std::pair<Positions, DeformedSurface> chosen(const Positions& places) const {
        if (options.surface != DeformedSurface::automatic)
            return {surface_of(options.surface, places), options.surface};
        std::vector<std::array<int, 2>> fewest;
        for (const DeformedSurface kind :
             {DeformedSurface::thin_plate, DeformedSurface::rigid, DeformedSurface::uniform}) {
            Positions surface = surface_of(kind, places);
            std::vector<std::array<int, 2>> folds = fold_edges(source, surface);
            if (folds.empty()) return {std::move(surface), kind};
            if (const Mesh flat = with_positions(source.mesh, surface); is_planar(flat))
                if (std::optional<Mesh> open = unfolded(flat)) return {std::move(open->positions), kind};
            if (fewest.empty() || folds.size() < fewest.size()) fewest = std::move(folds);
        }
        std::vector<int> ends;
        for (const auto& edge : fewest) ends.insert(ends.end(), edge.begin(), edge.end());
        throw Error(Cause::bad_boundary,
                    "every surface that was tried through the handles has folds, " + std::to_string(fewest.size()) +
                        " edges at least",
                    "move the handles in smaller steps, or give a surface", {Things::edges, std::move(ends)});
    }

    /// Handles stay, the rest of the boundary slides.
    TargetConstraints constraints(const Mesh& start) const {
        TargetConstraints result;
        std::vector<char> fixed(static_cast<std::size_t>(start.vertex_count()), 0);
        for (const int v : handles) fixed[v] = 1;
        const FeatureCurves border = feature_curves(start, source.topology, {});
        for (const int v : border.corners) fixed[v] = 1;
        for (const FeatureCurves::Curve& curve : border.curves) {
            Positions points(static_cast<Eigen::Index>(curve.vertices.size()), 3);
            for (std::size_t i = 0; i < curve.vertices.size(); ++i)
                points.row(static_cast<Eigen::Index>(i)) = start.point(curve.vertices[i]);
            const int index = static_cast<int>(result.curves.size());
            result.curves.push_back(std::make_shared<PolylineCurve>(points, curve.closed));
            for (const int v : curve.vertices)
                if (!fixed[v]) result.sliding.push_back({v, index});
        }
        for (int v = 0; v < start.vertex_count(); ++v)
            if (fixed[v]) result.fixed.push_back(v);
        return result;
    }

    /// The source with its vertices where a map begins. Not a surface of its own: faces may be reflex there.
    Surface where(Mesh begin) const {
        Surface start = source;
        start.mesh = std::move(begin);
        return start;
    }

    /// @return whether steps for the last power gained little in the end
    bool relax(TangentialMap& map, double first_power) const {
        map.set_damping(kDamping);
        map.set_progress(options.progress);
        std::optional<TargetMap> best;
        double least = std::numeric_limits<double>::infinity();
        bool settled = false;
        double power = first_power / 2;
        while ((power *= 2) <= options.last_power) {
            settled = map.relax(power, options.steps_of_power, options.tolerance) < options.steps_of_power;
            if (options.goal != DeformGoal::spread) continue;
            const double spread = mu_statistics(map.coefficients(), elements.operators.weights).standard_deviation;
            if (spread < least) {
                least = spread;
                best = map.map();
            }
        }
        if (best) map.return_to(std::move(*best));
        return settled;
    }

    /// What the record tells of positions on a target.
    Deformation measured(const Target& target, const Target::Points& points, const Mesh& begin) const {
        Deformation result;
        result.positions = positions_of(points);
        result.surface = target.mesh() ? *target.mesh() : begin;
        if (target.mesh()) result.places = beltrami::places_of(points);
        result.distortion = distortion(elements.operators, result.positions, normals_of(points));
        result.of_surface = distortion(elements.operators, begin.positions, normals_at(target, begin));
        const std::vector<int> free = flipped_freely(result.distortion);
        std::set_difference(result.distortion.flipped.begin(), result.distortion.flipped.end(), free.begin(),
                            free.end(), std::back_inserter(result.forced));
        result.folds = fold_edges(source, result.positions);
        result.area_ratio = surface_area(with_positions(source.mesh, result.positions)) / surface_area(source.mesh);
        return result;
    }

    /// Of a target that is the mesh itself those of its vertices.
    static Positions normals_at(const Target& target, const Mesh& begin) {
        return normals_of(nearest_points(target, begin.positions));
    }

    /// Faces that are flipped though not at a corner whose triangle the handles' places alone turn over.
    std::vector<int> flipped_freely(const Distortion& result) const {
        std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
        std::vector<char> free(static_cast<std::size_t>(source.mesh.face_count()), 0);
        for (const int v : handles) held[v] = 1;
        const Operators& own = elements.operators;
        for (int s = 0; s < own.sample_count(); ++s) {
            const auto v = own.stencil(s);
            const bool forced = std::all_of(v.begin(), v.end(), [&](int i) { return held[i] != 0; });
            if (!forced && std::abs(result.mu[s]) > 1) free[own.faces[s]] = 1;
        }
        std::vector<int> faces;
        for (const int f : result.flipped)
            if (free[f]) faces.push_back(f);
        return faces;
    }

    /// k conj(φ)/|φ| of an extremal map at the elements' samples; nothing where these are others than the map's.
    std::optional<Eigen::VectorXcd> coefficient_of(const ExtremalMap& extremal) const {
        const Operators& own = elements.operators;
        if (extremal.split || extremal.phi.size() != own.sample_count() || own.sample_count() != own.face_count)
            return {};
        Eigen::VectorXcd mu = Eigen::VectorXcd::Zero(extremal.phi.size());
        for (Eigen::Index s = 0; s < mu.size(); ++s)
            if (const double size = std::abs(extremal.phi[s]); size > 0)
                mu[s] = extremal.k * std::conj(extremal.phi[s]) / size;
        return mu;
    }

    /// The way by the plane adds the errors of a chart. Steps along the surface itself to the coefficient of the
    /// differential flip nothing: where that spreads |μ| less it is the result. Where the way by the plane flips faces,
    /// they begin at the map of least maximum.
    void follow_differential(const Target& target, const Mesh& begin, const TargetConstraints& held,
                             const ExtremalMap& extremal, Deformation& result) const {
        std::optional<Eigen::VectorXcd> wanted = coefficient_of(extremal);
        if (!wanted) return;
        try {
            const bool upright = result.distortion.flipped.empty();
            const Surface start = where(upright ? with_positions(begin, result.positions) : begin);
            TangentialMap map(start, elements.operators, target, held, 0);
            if (!map.folded().empty()) return;
            double least = result.distortion.standard_deviation;
            if (!upright) {  // from the least maximum, which is nearer than the beginning
                relax(map, 2);
                least = measured(target, map.points(), begin).distortion.standard_deviation;
            }
            map.set_damping(kDamping);
            map.set_wanted(std::move(*wanted));
            map.relax(2, kDifferentialSteps, kDifferentialTolerance);
            Deformation along = measured(target, map.points(), begin);
            if (along.distortion.standard_deviation < least) result = std::move(along);
        } catch (const Error& error) {  // then it stays as it is
            if (error.cause() == Cause::cancelled) throw;
        }
    }

    /// A target that can be unrolled, where the map begins on it, and what is held.
    struct UnrolledTarget {
        const ParametricTarget* surface;
        UnrolledPlaces places;
        std::vector<char> fixed;
    };
    std::optional<UnrolledTarget> unrolled_target(const Target& target, const Mesh& begin,
                                                  const TargetConstraints& held) const {
        const auto* const surface = dynamic_cast<const ParametricTarget*>(&target);
        if (!surface) return {};
        std::optional<UnrolledPlaces> places =
            unrolled_places(*surface, source.mesh.faces, nearest_points(target, begin.positions));
        if (!places) return {};
        std::vector<char> fixed(static_cast<std::size_t>(begin.vertex_count()), 0);
        for (const int v : held.fixed) fixed[v] = 1;
        return UnrolledTarget{surface, std::move(*places), std::move(fixed)};
    }

    /// Whether the source is an annulus whose boundary, and nothing else, is held.
    bool is_held_annulus() const {
        const Topology& topology = source.topology;
        return maps.refusal().empty() && topology.boundary_loops.size() == 2 &&
               std::all_of(handles.begin(), handles.end(), [&](int v) { return topology.on_boundary[v] != 0; });
    }

    /// The extremal map of an annulus, or the QC iteration, on a target that can be unrolled.
    std::optional<Deformation> by_unrolled_map(const Target& target, const Mesh& begin,
                                               const TargetConstraints& held) const {
        const std::optional<UnrolledTarget> unrolled = unrolled_target(target, begin, held);
        if (!unrolled) return {};
        if (options.goal == DeformGoal::dilatation) {
            if (!is_held_annulus()) return {};
            ExtremalMap map =
                extremal_unrolled_map(source, elements, unrolled->places, unrolled->fixed, options.progress);
            Deformation result = measured(target, rolled_up(*unrolled->surface, map.map), begin);
            if (!flipped_freely(result.distortion).empty()) return {};
            result.goal = options.goal;
            result.steps = map.iterations;
            result.settled = map.termination == Termination::converged;
            result.factorizations = map.factorizations + surfaces.factorization_count();
            result.warnings = map.warnings;
            result.extremal = std::move(map);
            return result;
        }
        UniformOptions uniform;
        uniform.max_iterations = kUniformSteps;
        uniform.progress = options.progress;
        const UnrolledMap map = uniform_unrolled_map(source.mesh, elements, unrolled->places, unrolled->fixed, uniform);
        Deformation result = measured(target, rolled_up(*unrolled->surface, map.vertices), begin);
        if (!flipped_freely(result.distortion).empty()) return {};
        result.goal = options.goal;
        result.steps = map.solves;
        result.settled = map.converged;
        result.factorizations = map.solves + surfaces.factorization_count();
        return result;
    }

    /// By way of the plane: the extremal map, or the QC iteration. Nothing where there is none that does not fold; why
    /// is among the warnings.
    std::optional<Deformation> by_held_map(const Target& target, const Mesh& begin, const TargetConstraints& held,
                                           Warnings& warnings) {
        const char* const what = options.goal == DeformGoal::dilatation ? "the extremal map" : "the QC iteration";
        if (std::optional<Deformation> unrolled = by_unrolled_map(target, begin, held)) return unrolled;
        std::string reason = maps.refusal();
        if (reason.empty()) try {
                HeldMap map = options.goal == DeformGoal::dilatation
                                  ? maps.extremal(begin, options.progress)
                                  : maps.uniform(begin, kUniformSteps, options.progress);
                Deformation result = measured(target, nearest_points(target, map.positions), begin);
                if (map.extremal) follow_differential(target, begin, held, *map.extremal, result);
                const std::vector<int> flipped = flipped_freely(result.distortion);
                if (flipped.empty()) {
                    result.goal = options.goal;
                    result.steps = map.steps;
                    result.settled = map.settled;
                    result.factorizations = map.factorizations + surfaces.factorization_count();
                    result.extremal = std::move(map.extremal);
                    result.warnings = std::move(map.warnings);
                    return result;
                }
                reason = "it flips " + counted(flipped.size(), "face", "faces") + " on the surface";
            } catch (const Error& error) {
                if (error.cause() == Cause::cancelled) throw;
                reason = error.what();
            }
        warnings.push_back(
            {WarningKind::fallback,
             std::string(what) + " is not to be had, and the largest |mu| was made small instead: " + reason});
        return {};
    }

    /// @param begin positions of the vertices on the target, without folds
    /// @throw Error not_solved naming faces if there are
    Deformation by_powers(const Target& target, const Mesh& begin, const TargetConstraints& held, double first_power) {
        const Surface start = where(begin);
        TangentialMap map(start, elements.operators, target, held, 0);
        if (const std::vector<int> folded = map.folded(); !folded.empty()) {
            std::vector<int> faces;
            faces.reserve(folded.size());
            for (const int s : folded) faces.push_back(elements.operators.faces[s]);
            faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
            const std::string sentence = counted_faces(faces.size()) + " where the map begins";
            throw Error(Cause::not_solved, sentence, "move the handles in smaller steps",
                        {Things::faces, std::move(faces)});
        }
        const bool settled = relax(map, first_power);
        Deformation result = measured(target, map.points(), begin);
        result.settled = settled;
        result.goal = options.goal == DeformGoal::spread ? DeformGoal::spread : DeformGoal::largest;
        result.steps = map.steps();
        result.factorizations = map.factorization_count() + surfaces.factorization_count();
        return result;
    }

    /// Both where |μ| is to spread little, else the one that is asked for, or the other where there is none.
    Deformation along(const Target& target, const Mesh& begin, const TargetConstraints& held, double first_power) {
        if (options.goal == DeformGoal::largest) return by_powers(target, begin, held, first_power);
        Warnings warnings;
        std::optional<Deformation> direct = by_held_map(target, begin, held, warnings);
        if (direct && options.goal == DeformGoal::dilatation) return std::move(*direct);
        try {
            Deformation result = by_powers(target, begin, held, first_power);
            if (options.goal == DeformGoal::dilatation) append(result.warnings, warnings);
            if (!direct || result.distortion.standard_deviation < direct->distortion.standard_deviation) return result;
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved || !direct) throw;
        }
        return std::move(*direct);
    }

    /// Why maps fold onto a target from which the handles' places are far.
    /// @param folded where
    /// @throw Error not_solved
    void require_places_on(const Target& target, const Positions& places, const Where& folded) const {
        const Eigen::VectorXd away = (positions_of(nearest_points(target, places)) - places).rowwise().norm();
        Eigen::Index farthest = 0;
        if (!(away.maxCoeff(&farthest) > kFarAway * std::sqrt(surface_area(source.mesh)))) return;
        const int vertex = handles[static_cast<std::size_t>(farthest)];
        throw Error(Cause::not_solved,
                    "faces fold on the surface that is given, and places of handles are not on it: that of vertex " +
                        std::to_string(vertex) + " is " + std::to_string(away[farthest]) + " away from it",
                    "give places on the surface", folded);
    }

    /// The same in a plane without folds; nothing if that cannot be had.
    std::optional<Mesh> unfolded(const Mesh& begin) const {
        std::vector<Freedom> freedoms(static_cast<std::size_t>(begin.vertex_count()), Freedom::free);
        for (const int v : handles) freedoms[v] = Freedom::fixed;
        for (const auto& loop : source.topology.boundary_loops)
            for (const int v : loop) freedoms[v] = Freedom::fixed;
        Surface corners = source;
        corners.operators = elements.operators;  // a quad folds at its corners first
        const FoldFreeMap map = fold_free_map(
            corners, freedoms, Eigen::VectorXcd::Zero(corners.operators.sample_count()), planar_coordinates(begin));
        Mesh result = begin;
        const double side = seen_from_below(begin) ? -1 : 1;
        for (int v = 0; v < begin.vertex_count(); ++v)
            result.positions.row(v).head<2>() << map.map[v].real(), side * map.map[v].imag();
        // What the handles alone turn over stays so.
        const Positions up = Eigen::RowVector3d(0, 0, side).replicate(begin.vertex_count(), 1);
        if (!flipped_freely(distortion(elements.operators, result.positions, up)).empty()) return {};
        return result;
    }

    /// Where maps onto a target may begin: surfaces through the handles at its nearest points, what folds in a plane
    /// unfolded. The first without folds, else the first.
    Mesh beginning_on(const Target& target, const Positions& places) const {
        std::optional<Mesh> first;
        for (const DeformedSurface kind :
             {DeformedSurface::thin_plate, DeformedSurface::rigid, DeformedSurface::uniform}) {
            if (options.surface != DeformedSurface::automatic && options.surface != kind) continue;
            Mesh begin = with_positions(source.mesh, positions_of(nearest_points(target, surface_of(kind, places))));
            const Positions normals = normals_at(target, begin);
            if (distortion(elements.operators, begin.positions, normals).flipped.empty()) return begin;
            if (is_planar(begin))
                if (std::optional<Mesh> open = unfolded(begin)) return std::move(*open);
            if (!first) first = std::move(begin);
        }
        return std::move(*first);
    }
};

DeformSolver::DeformSolver(const Surface& source, std::vector<int> handles, DeformOptions options) {
    options.validate();
    for (const int v : handles)
        if (v < 0 || v >= source.mesh.vertex_count())
            throw Error(Cause::bad_boundary, "there is no vertex " + std::to_string(v), "", {Things::vertices, {v}});
    parts_ = std::make_unique<Parts>(source, std::move(handles), std::move(options));
}

DeformSolver::~DeformSolver() = default;

Deformation DeformSolver::solve(const Positions& places) {
    Parts& p = *parts_;
    const auto [positions, kind] = p.chosen(places);
    const Mesh surface = with_positions(p.source.mesh, positions);
    const MeshTarget target(surface);
    const TargetConstraints held = p.constraints(surface);
    Deformation result;
    // By way of the plane the last map is where the next begins anyway, and the surface is the mesh itself.
    const bool by_plane = p.options.goal != DeformGoal::largest && p.maps.refusal().empty();
    if (!p.last.empty() && !by_plane) {
        try {  // from the last one's places, the largest power at once
            result = p.along(target, with_positions(surface, points_at(surface, p.last)), held, p.options.last_power);
            result.warm = true;
        } catch (const Error& error) {
            if (error.cause() == Cause::cancelled) throw;
            p.last.clear();
        }
    }
    if (!result.warm) {
        result = p.along(target, surface, held, 2);
        result.warm = by_plane && !p.last.empty();
    }
    result.of_surface = distortion(p.elements.operators, surface.positions, vertex_normals(surface));
    result.kind = kind;
    p.last = result.places;
    return result;
}

Deformation DeformSolver::solve_onto(const Target& target, const Positions& places) {
    Parts& p = *parts_;
    const Mesh begin = p.beginning_on(target, places);
    TargetConstraints held;
    held.fixed = p.handles;
    std::vector<char> fixed(static_cast<std::size_t>(begin.vertex_count()), 0);
    for (const int v : p.handles) fixed[v] = 1;
    for (const auto& loop : p.source.topology.boundary_loops)
        for (const int v : loop)
            if (!fixed[v]) held.fixed.push_back(v);
    Deformation result;
    try {
        result = p.along(target, begin, held, 2);
    } catch (const Error& error) {
        if (error.cause() == Cause::not_solved) p.require_places_on(target, places, error.where());
        throw;
    }
    result.kind = DeformedSurface::given;
    return result;
}

}  // namespace beltrami
