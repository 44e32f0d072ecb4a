#include <beltrami/registration/register_curves.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/flow/led_map.h>
#include <beltrami/flow/unfolded_patches.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/registration/curve_start.h>
#include <beltrami/registration/held_curves.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/target_image.h>
#include <beltrami/registration/ways_to_cut.h>
#include <beltrami/solve/target_step.h>
#include <beltrami/sphere/moebius_fit.h>
#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/sphere_faces.h>
#include <beltrami/unfold/sphere_repair.h>

namespace beltrami {

namespace {

constexpr std::size_t kMostTried = 2;  // of the starts in a group

void require_pairs(std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves) {
    for (const SurfaceLandmark& landmark : landmarks)
        if (std::isfinite(landmark.weight))
            throw Error(Cause::bad_option, "landmark " + std::to_string(landmark.vertex) + " is soft",
                        "least Lᵖ maps meet their landmarks: give no weights", {Things::vertices, {landmark.vertex}});
    for (std::size_t c = 0; c < curves.size(); ++c)
        if (curves[c].source.points.size() != curves[c].target.points.size() ||
            curves[c].source.closed != curves[c].target.closed)
            throw Error(Cause::bad_boundary,
                        "curve " + std::to_string(c + 1) + " has " + std::to_string(curves[c].source.points.size()) +
                            " points and its partner " + std::to_string(curves[c].target.points.size()) +
                            ", or one of them is closed and the other is not",
                        "give as many points of the partner, in the same order");
}

/// The target with its curves, and what the source's have to keep to.
struct Wanted {
    std::reference_wrapper<const TargetImage> image;
    MeshWithCurves target;
    Positions points;  ///< of the target's vertices with those of the curves
    TargetConstraints constraints;

    const TargetImage& model() const { return image; }
};

/// Landmarks go to their places, unless a curve has them.
void hold_landmarks(std::span<const SurfaceLandmark> landmarks, Wanted& wanted, Positions& start) {
    for (const SurfaceLandmark& landmark : landmarks) {
        const bool slides = std::any_of(wanted.constraints.sliding.begin(), wanted.constraints.sliding.end(),
                                        [&](const auto& slide) { return slide.vertex == landmark.vertex; });
        const bool fixed = std::find(wanted.constraints.fixed.begin(), wanted.constraints.fixed.end(),
                                     landmark.vertex) != wanted.constraints.fixed.end();
        if (fixed || slides)
            throw Error(Cause::bad_boundary, "landmark " + std::to_string(landmark.vertex) + " lies on a curve",
                        "leave it out, and name it as a point of the curve", {Things::vertices, {landmark.vertex}});
        wanted.constraints.fixed.push_back(landmark.vertex);
        start.row(landmark.vertex) = wanted.model().place(wanted.model().points(), landmark.place);
    }
}

/// Largest distance in space of a vertex of a curve from its partner.
double distance_from_curves(const Mesh& target, std::span<const MeshPoint> places, const MeshWithCurves& source,
                            const MeshWithCurves& on_target) {
    double largest = 0;
    for (std::size_t c = 0; c < source.curves.size(); ++c) {
        const auto& partner = on_target.curves[c];
        const PolylineCurve curve(on_target.mesh.positions(partner.vertices, Eigen::all), partner.closed);
        for (const int v : source.curves[c].vertices) {
            const Eigen::Vector3d point = point_at(target, places[v]);
            largest = std::max(largest, (point - curve.point(curve.nearest(point))).norm());
        }
    }
    return largest;
}

/// Landmarks with the given points of curves.
std::vector<SurfaceLandmark> with_given_points(std::span<const SurfaceLandmark> landmarks,
                                               std::span<const CurvePair> curves) {
    std::vector<SurfaceLandmark> all(landmarks.begin(), landmarks.end());
    for (const CurvePair& pair : curves)
        for (std::size_t i = 0; i < pair.source.points.size(); ++i)
            all.push_back({nearest_vertex(pair.source.points[i]), pair.target.points[i]});
    return all;
}

/// Of closed surfaces, of the source's own vertices.
Positions start_of_landmarks(const Surface& source, const Wanted& wanted, std::span<const SurfaceLandmark> landmarks,
                             const CurveRegistrationOptions& options) {
    std::vector<SphereLandmark> images;
    for (const SurfaceLandmark& landmark : landmarks)
        images.push_back({landmark.vertex, wanted.model().place(wanted.model().points(), landmark.place)});
    ExtremalSphereOptions once;
    once.max_iterations = 1;
    return extremal_sphere_map(source, sphere_map(source, options.sphere).positions, images, once).start;
}

/// Of surfaces with boundary, of all vertices: folds that are left when curves have gone to their partners are opened,
/// the boundary held.
Positions open_start(const Surface& source, const Surface& target, const Wanted& wanted,
                     std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                     const CurveRegistrationOptions& options) {
    OpenRegistrationOptions how;
    how.outer_loop = options.outer_loop;
    how.target_outer_loop = options.target_outer_loop;
    const OpenRegistration found = register_open(source, target, with_given_points(landmarks, curves), how);
    return wanted.model().at(wanted.model().points(), found.places);
}

std::vector<int> held_by(const TargetConstraints& constraints) {
    std::vector<int> held = constraints.fixed;
    for (const auto& slide : constraints.sliding) held.push_back(slide.vertex);
    return held;
}

/// Turns flipped faces on the sphere up, as far as that goes.
void turn_up(const Surface& source, const TargetConstraints& constraints, Positions& start) {
    const SphereFaces faces(source);
    if (!faces.flipped(start).empty()) repair_sphere_map(source, faces, start, held_by(constraints));
}

void open_folds(const Surface& source, const TargetConstraints& constraints, Positions& start) {
    const Eigen::VectorXcd plane = DomainImage::in_plane(start);
    if (distortion(source.operators, plane).flipped.empty()) return;
    std::vector<Freedom> freedoms(static_cast<std::size_t>(source.mesh.vertex_count()), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v]) freedoms[v] = Freedom::free;
    for (const int v : constraints.fixed) freedoms[v] = Freedom::fixed;
    for (const auto& slide : constraints.sliding) freedoms[slide.vertex] = Freedom::fixed;
    start = DomainImage::in_space(
        fold_free_map(source, freedoms, Eigen::VectorXcd::Zero(source.operators.sample_count()), plane).map);
}

/// A map of the source's own vertices, or of those with the vertices of curves, as one of all of them.
Positions on_curves(const Wanted& wanted, const MeshWithCurves& source, const Positions& map) {
    const auto own = source.mesh.vertex_count() - static_cast<Eigen::Index>(source.places.size());
    return map.rows() == own ? wanted.model().with_places(map, source.places) : map;
}

/// Where a start stays folded: of it and those that are led to the same places, from where curves were not held and,
/// between closed surfaces, from the map of the landmarks, the one with the fewest flips.
TargetMap least_flipped_start(const Surface& source, const Surface& with_curves, const Wanted& wanted,
                              const MeshWithCurves& curved, TargetMap start, const Positions& unheld,
                              std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                              const CurveRegistrationOptions& options) {
    const Target& target = wanted.model().target();
    int least = flipped_samples(with_curves.operators, start);
    TargetMap best = start;
    const auto lead_from = [&](const Positions& from) {
        LedMap led = led_map(with_curves, target, wanted.constraints, {nearest_points(target, from), {}}, start);
        if (led.flips >= least) return;
        least = led.flips;
        best = std::move(led.map);
    };
    if (source.topology.boundary_loops.empty()) try {
            lead_from(on_curves(wanted, curved,
                                start_of_landmarks(source, wanted, with_given_points(landmarks, curves), options)));
        } catch (const Error& error) {
            if (error.cause() == Cause::cancelled) throw;  // landmarks that are too close, or fold
        }
    if (least > 0) lead_from(unheld);
    return best;
}

/// A problem with its curves, its start and what is held there.
struct Ready {
    MeshWithCurves source;
    Wanted wanted;
    Positions unheld;  ///< the start without curves and landmarks at their places
    TargetMap begin;
    std::vector<int> start_flipped;
    int flips = 0;    ///< of begin, where folds have been opened as far as that goes, and …
    double mean = 0;  ///< … its mean |μ|
};

Ready made_ready(const Surface& source, const Surface& target, const TargetImage& model, Curved curved,
                 std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                 const CurveRegistrationOptions& options) {
    const bool closed = source.topology.boundary_loops.empty();
    Ready ready{std::move(curved.source), {model, std::move(curved.target), {}, {}}, {}, {}, {}, 0, 0};
    Wanted& wanted = ready.wanted;
    wanted.points = model.with_places(model.points(), wanted.target.places);
    Positions start = !options.start.empty() ? model.at(model.points(), options.start)
                      : !closed              ? open_start(source, target, wanted, landmarks, curves, options)
                      : curves.empty()
                          ? start_of_landmarks(source, wanted, landmarks, options)
                          : model.at(wanted.points, map_cut_along_curves(curved.cut_source, curved.cut_target));
    ready.unheld = on_curves(wanted, ready.source, start);
    Positions held = ready.unheld;
    std::vector<char> slides;
    for (const CurvePair& pair : curves) slides.push_back(pair.slides ? 1 : 0);
    hold_curves(ready.source, {wanted.target.curves, wanted.points}, slides, model.target(), wanted.constraints, held);
    hold_landmarks(landmarks, wanted, held);
    const Surface with_curves(ready.source.mesh);
    ready.start_flipped = model.distortion_of(with_curves, held).flipped;
    if (closed)
        turn_up(with_curves, wanted.constraints, held);
    else
        open_folds(with_curves, wanted.constraints, held);
    if (!closed) slide_boundary(wanted.constraints, with_curves, model.target(), held);
    ready.begin = target_map(with_curves, model.target(), wanted.constraints, held);
    std::vector<char> at_rest(static_cast<std::size_t>(with_curves.mesh.vertex_count()), 0);
    for (const int v : held_by(wanted.constraints)) at_rest[v] = 1;
    ready.flips = unfold_flipped_patches(with_curves, model.target(), at_rest, ready.begin);
    ready.mean =
        distortion(with_curves.operators, positions_of(ready.begin.points), normals_of(ready.begin.points)).mean;
    return ready;
}

/// The source's conformal sphere, laid on the target's by the Möbius map that takes given points of curves nearest to
/// their partners.
Positions fitted_sphere(const Surface& source, const TargetImage& model, std::span<const CurvePair> curves,
                        const SphereMapOptions& options) {
    std::vector<int> vertices;
    std::vector<MeshPoint> places;
    for (const CurvePair& pair : curves)
        for (std::size_t i = 0; i < pair.source.points.size(); ++i) {
            const int vertex = nearest_vertex(pair.source.points[i]);
            if (std::find(vertices.begin(), vertices.end(), vertex) != vertices.end()) continue;
            vertices.push_back(vertex);
            places.push_back(pair.target.points[i]);
        }
    return moebius_fitted(sphere_map(source, options).positions, vertices, model.at(model.points(), places));
}

/// Lengths of curves on the two spheres: what curves that slide are divided by, for there the map is nearest to
/// keeping them.
void measure_on_spheres(Curved& way, const TargetImage& model, const Positions& own) {
    for (MeshWithCurves* mesh : {&way.source, &way.cut_source})
        measure_curves(*mesh, model.with_places(own, mesh->places));
    for (MeshWithCurves* mesh : {&way.target, &way.cut_target})
        measure_curves(*mesh, model.with_places(model.points(), mesh->places));
}

/// What is asked of the search.
struct Task {
    const Surface &source, &target;
    const TargetImage& model;
    std::span<const SurfaceLandmark> landmarks;
    std::span<const CurvePair> curves;
    const CurveRegistrationOptions& options;
};

/// The map with the fewest flips, and its start.
struct Found {
    SurfaceFlowMap map;
    Ready from;
};

void keep_better(const Task& task, Ready next, std::optional<Found>& best) {
    const Surface with_curves(next.source.mesh);
    SurfaceFlowMap map = least_lp_map(with_curves, task.model.target(), {task.options.p, {}}, next.wanted.constraints,
                                      next.begin, task.options.flow);
    if (best && map.distortion.flipped.size() >= best->map.distortion.flipped.size()) return;
    best = Found{std::move(map), std::move(next)};
}

bool has_no_flips(const std::optional<Found>& found) {
    return found && found->map.distortion.flipped.empty();
}

/// Tries the starts of one way to cut after another, those with the fewest flips and the least distortion first.
/// @param failure the last start that could not be made, where another one may be
void try_ways(const Task& task, std::vector<Curved> ways, const std::optional<Positions>& sphere,
              std::optional<Found>& best, std::exception_ptr& failure) {
    const bool only = ways.size() == 1;
    std::vector<Ready> starts;
    for (Curved& way : ways) {
        try {
            if (sphere) measure_on_spheres(way, task.model, *sphere);
            starts.push_back(made_ready(task.source, task.target, task.model, std::move(way), task.landmarks,
                                        task.curves, task.options));
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved && (only || error.cause() != Cause::bad_boundary)) throw;
            failure = std::current_exception();
        }
    }
    std::stable_sort(starts.begin(), starts.end(), [](const Ready& a, const Ready& b) {
        return std::pair(a.flips, a.mean) < std::pair(b.flips, b.mean);
    });
    for (std::size_t i = 0; i < std::min(starts.size(), kMostTried) && !has_no_flips(best); ++i)
        keep_better(task, std::move(starts[i]), best);
}

/// Where a start stays folded: of it and those that are led to the same places the one with the fewest flips.
Ready led(const Task& task, Ready from) {
    from.begin = least_flipped_start(task.source, Surface(from.source.mesh), from.wanted, from.source,
                                     std::move(from.begin), from.unheld, task.landmarks, task.curves, task.options);
    return from;
}

Found search(const Task& task) {
    std::vector<CurveThrough> here, there;
    bool all_slide = true;
    for (const CurvePair& pair : task.curves) {
        here.push_back(pair.source);
        there.push_back(pair.target);
        all_slide = all_slide && pair.slides;
    }
    const Mesh &source = task.source.mesh, &target = task.target.mesh;
    const bool cut = task.source.topology.boundary_loops.empty() && task.options.start.empty() && !task.curves.empty();
    std::optional<Positions> sphere;
    if (cut && all_slide) sphere = fitted_sphere(task.source, task.model, task.curves, task.options.sphere);
    std::optional<Found> best;
    std::exception_ptr failure;
    if (cut) {
        for (std::vector<Curved>& ways : ways_to_cut(source, target, here, there))
            if (!has_no_flips(best)) try_ways(task, std::move(ways), sphere, best, failure);
    } else {
        std::vector<Curved> one;
        one.push_back(along_curves(source, target, here, there));
        try_ways(task, std::move(one), {}, best, failure);
    }
    if (!best) std::rethrow_exception(failure);
    if (!has_no_flips(best)) {
        Ready again = best->from;
        keep_better(task, led(task, std::move(again)), best);
    }
    return std::move(*best);
}

/// From the least Lᵖ map, which has no flips, to that of least dilatation.
void go_on_to_extremal(const Found& found, const TargetConstraints& constraints, const Target& target,
                       const CurveRegistrationOptions& options, LpRegistration& result) {
    ExtremalFlowOptions how;
    how.max_iterations = options.flow.max_iterations;
    how.progress = options.extremal_progress;
    const Surface with_curves(found.from.source.mesh);
    result.extremal = extremal_flow(with_curves, target, constraints, result.map.map, how);
    SurfaceFlowMap& map = result.map;
    map.map = result.extremal->map;
    map.distortion = distortion(with_curves.operators, positions_of(map.map.points), normals_of(map.map.points));
    map.termination = result.extremal->termination;
    map.iterations += result.extremal->iterations;
    map.factorizations += result.extremal->factorizations;
}

}  // namespace

LpRegistration register_least_lp(const Surface& source, const Surface& target,
                                 std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                                 const CurveRegistrationOptions& options) {
    require_pairs(landmarks, curves);
    const bool closed = source.topology.boundary_loops.empty();
    if (closed)
        require_sphere(source);
    else
        require_genus_zero(source);
    if (source.topology.boundary_loops.size() != target.topology.boundary_loops.size())
        throw Error(Cause::bad_mesh, "the two surfaces have different numbers of boundary loops",
                    "fill holes until they agree");
    LpRegistration result;
    std::unique_ptr<TargetImage> model;
    if (closed)
        model = std::make_unique<SphereImage>(target, options.sphere, result.warnings);
    else
        model = std::make_unique<DomainImage>(target, options.target_outer_loop);
    result.image = model->points();
    if (!options.start.empty() && static_cast<int>(options.start.size()) != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has places for another number of vertices");
    Found found = search({source, target, *model, landmarks, curves, options});
    result.map = std::move(found.map);
    const Wanted& wanted = found.from.wanted;
    result.source = found.from.source;
    result.start_flipped = found.from.start_flipped;
    if (const std::vector<int>& flipped = result.map.distortion.flipped; !flipped.empty())
        throw Error(Cause::not_solved,
                    counted(flipped.size(), "face stays", "faces stay") + " flipped: the start had " +
                        std::to_string(result.start_flipped.size()) + " that cannot be opened",
                    "give curves that run alike on both surfaces, fewer of them, or a start without flips",
                    {Things::faces, flipped});
    if (options.extremal) go_on_to_extremal(found, wanted.constraints, model->target(), options, result);
    const Positions own = positions_of(own_part(source, model->target(), wanted.constraints, result.map.map).points);
    result.places = model->locate(own);
    meet_landmarks(landmarks, result);
    result.carried.distortion = model->distortion_of(source, own);
    result.measure(source, target, result.carried.distortion.mu);
    result.divided = model->locate(positions_of(result.map.map.points));
    result.curve_distance = distance_from_curves(target.mesh, result.divided, result.source, wanted.target);
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
