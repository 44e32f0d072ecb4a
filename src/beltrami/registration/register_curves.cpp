#include <beltrami/registration/register_curves.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/registration/curve_start.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/sphere_faces.h>
#include <beltrami/unfold/sphere_repair.h>

namespace beltrami {

namespace {

/// A polyline of great circles.
class SphereCurve final : public SlideCurve {
  public:
    SphereCurve(const Positions& points, bool closed) : chords_(points, closed) {}
    double length() const override { return chords_.length(); }
    bool closed() const override { return chords_.closed(); }
    Eigen::Vector3d point(double s) const override { return chords_.point(s).normalized(); }
    Eigen::Vector3d tangent(double s) const override {
        const Eigen::Vector3d up = point(s), along = chords_.tangent(s);
        return (along - along.dot(up) * up).normalized();
    }
    double nearest(const Eigen::Vector3d& point) const override { return chords_.nearest(point); }

  private:
    PolylineCurve chords_;
};

/// What the target's surface becomes while maps to it are found: the unit sphere, or a circle domain in the plane z =
/// 0.
class Model {
  public:
    virtual ~Model() = default;
    /// #V×3 of the target.
    const Positions& points() const { return points_; }
    virtual const Target& target() const = 0;
    /// The point that a mean of points nearby stands for.
    virtual Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const = 0;
    virtual std::shared_ptr<const SlideCurve> curve(const Positions& points, bool closed) const = 0;
    virtual std::vector<MeshPoint> locate(const Positions& points) const = 0;
    virtual Distortion distortion_of(const Surface& source, const Positions& points) const = 0;

    Eigen::Vector3d place(const Positions& points, const MeshPoint& place) const {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3; ++i) mean += place.barycentric[i] * points.row(place.vertices[i]).transpose();
        return surface_point(mean);
    }
    Positions at(const Positions& points, std::span<const MeshPoint> places) const {
        Positions result(static_cast<Eigen::Index>(places.size()), 3);
        for (std::size_t i = 0; i < places.size(); ++i)
            result.row(static_cast<Eigen::Index>(i)) = place(points, places[i]);
        return result;
    }
    /// Points of vertices with those that curves add.
    Positions with_places(const Positions& points, std::span<const MeshPoint> places) const {
        Positions result(points.rows() + static_cast<Eigen::Index>(places.size()), 3);
        result << points, at(points, places);
        return result;
    }

  protected:
    Positions points_;
};

class SphereModel final : public Model {
  public:
    SphereModel(const Surface& target, const SphereMapOptions& options, Warnings& warnings)
        : faces_(target.mesh.faces) {
        require_sphere(target);
        SphereMap map = sphere_map(target, options);
        append(warnings, map.warnings);
        points_ = std::move(map.positions);
    }
    const Target& target() const override { return sphere_; }
    Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const override { return mean.normalized(); }
    std::shared_ptr<const SlideCurve> curve(const Positions& points, bool closed) const override {
        return std::make_shared<SphereCurve>(points, closed);
    }
    std::vector<MeshPoint> locate(const Positions& points) const override {
        return SphereLocator(faces_, points_).locate(points);
    }
    Distortion distortion_of(const Surface& source, const Positions& points) const override {
        return distortion(source.operators, points, points);
    }

  private:
    const FaceList& faces_;
    SphereTarget sphere_;
};

class DomainModel final : public Model {
  public:
    DomainModel(const Surface& target, int outer_loop)
        : surface_(target), chart_(circle_domain_chart(target, outer_loop)), domain_(circle_target(chart_)) {
        points_ = in_space(chart_.chart.vertices);
    }
    static Positions in_space(const Eigen::VectorXcd& plane) {
        Positions points(plane.size(), 3);
        points << plane.real(), plane.imag(), Eigen::VectorXd::Zero(plane.size());
        return points;
    }
    static Eigen::VectorXcd in_plane(const Positions& points) {
        Eigen::VectorXcd plane(points.rows());
        plane.real() = points.col(0);
        plane.imag() = points.col(1);
        return plane;
    }
    const Target& target() const override { return domain_; }
    Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const override { return mean; }
    std::shared_ptr<const SlideCurve> curve(const Positions& points, bool closed) const override {
        return std::make_shared<PolylineCurve>(points, closed);
    }
    std::vector<MeshPoint> locate(const Positions& points) const override {
        const Eigen::VectorXcd plane = in_plane(points);
        return locate_in_chart(surface_, chart_.chart.vertices, std::vector<Complex>(plane.begin(), plane.end()));
    }
    Distortion distortion_of(const Surface& source, const Positions& points) const override {
        return distortion(source.operators, in_plane(points));
    }

  private:
    const Surface& surface_;
    CircleDomainChart chart_;
    DomainTarget domain_;
};

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

MeshWithCurves of_surface(const char* name, const Mesh& mesh, const std::vector<CurveThrough>& curves) {
    try {
        return mesh_with_curves(mesh, curves);
    } catch (const Error& error) {
        throw Error(error.cause(), std::string("the ") + name + ": " + error.what(), {}, error.where());
    }
}

/// Both meshes with their curves, and what they are cut along for the start: open curves one after the other, joined
/// from end to beginning, so that the surfaces come apart into disks; where no geodesics join them, the curves alone.
struct Curved {
    MeshWithCurves source, target, cut_source, cut_target;
};

std::vector<CurveThrough> joined(const std::vector<CurveThrough>& curves) {
    std::vector<CurveThrough> result{{}};
    for (const CurveThrough& curve : curves)
        if (curve.closed)
            result.push_back(curve);
        else
            result[0].points.insert(result[0].points.end(), curve.points.begin(), curve.points.end());
    return result;
}

/// The curves of a mesh that was made with joined ones.
MeshWithCurves taken_apart(const MeshWithCurves& whole, const std::vector<CurveThrough>& curves) {
    MeshWithCurves result = whole;
    result.curves.clear();
    std::size_t first = 0, next_closed = 1;
    for (const CurveThrough& curve : curves) {
        if (curve.closed) {
            result.curves.push_back(whole.curves[next_closed++]);
            continue;
        }
        const MeshWithCurves::Chain& chain = whole.curves[0];
        const std::size_t last = first + curve.points.size() - 1;
        const int from = chain.given[first], to = chain.given[last];
        MeshWithCurves::Chain part;
        for (int i = from; i <= to; ++i) {
            part.vertices.push_back(chain.vertices[i]);
            part.lengths.push_back(chain.lengths[i] - chain.lengths[from]);
        }
        for (std::size_t g = first; g <= last; ++g) part.given.push_back(chain.given[g] - from);
        part.length = part.lengths.back();
        result.curves.push_back(std::move(part));
        first = last + 1;
    }
    return result;
}

Curved with_curves_of(const Mesh& source, const Mesh& target, const std::vector<CurveThrough>& here,
                      const std::vector<CurveThrough>& there) {
    const auto open = std::count_if(here.begin(), here.end(), [](const CurveThrough& curve) { return !curve.closed; });
    MeshWithCurves a = of_surface("source", source, here), b = of_surface("target", target, there);
    if (open > 1) try {
            MeshWithCurves whole_a = mesh_with_curves(source, joined(here)),
                           whole_b = mesh_with_curves(target, joined(there));
            return {taken_apart(whole_a, here), taken_apart(whole_b, there), std::move(whole_a), std::move(whole_b)};
        } catch (const Error& error) {
            if (error.cause() != Cause::bad_boundary) throw;
        }
    return {a, b, a, b};
}

/// The target with its curves, and what the source's have to keep to.
struct Wanted {
    const Model& model;
    MeshWithCurves target;
    Positions points;  ///< of the target's vertices with those of the curves
    TargetConstraints constraints;
};

Eigen::Vector3d partner_point(const Wanted& wanted, const MeshWithCurves& source, std::size_t c, std::size_t i) {
    const auto& partner = wanted.target.curves[c];
    const auto [segment, part] = partner_place(source.curves[c], i, partner);
    const int a = partner.vertices[segment], b = partner.vertices[(segment + 1) % partner.vertices.size()];
    return wanted.model.surface_point((1 - part) * wanted.points.row(a) + part * wanted.points.row(b));
}

/// Fixes and lets slide what curves hold; their vertices are put to their partners.
void hold_curves(const MeshWithCurves& source, std::span<const CurvePair> curves, Wanted& wanted, Positions& start) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const auto& chain = source.curves[c];
        const auto& partner = wanted.target.curves[c];
        const auto curve = static_cast<int>(wanted.constraints.curves.size());
        if (curves[c].slides)
            wanted.constraints.curves.push_back(
                wanted.model.curve(wanted.points(partner.vertices, Eigen::all), partner.closed));
        for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
            const bool end = !chain.closed && (i == 0 || i + 1 == chain.vertices.size());
            start.row(chain.vertices[i]) = partner_point(wanted, source, c, i);
            if (curves[c].slides && !end)
                wanted.constraints.sliding.push_back({chain.vertices[i], curve});
            else
                wanted.constraints.fixed.push_back(chain.vertices[i]);
        }
    }
}

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
        start.row(landmark.vertex) = wanted.model.place(wanted.model.points(), landmark.place);
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
            Eigen::Vector3d point = Eigen::Vector3d::Zero();
            for (int i = 0; i < 3; ++i) point += places[v].barycentric[i] * target.point(places[v].vertices[i]);
            largest = std::max(largest, (point - curve.point(curve.nearest(point))).norm());
        }
    }
    return largest;
}

Positions start_of_landmarks(const Surface& source, const Wanted& wanted, std::span<const SurfaceLandmark> landmarks,
                             const CurveRegistrationOptions& options) {
    std::vector<SphereLandmark> images;
    for (const SurfaceLandmark& landmark : landmarks)
        images.push_back({landmark.vertex, wanted.model.place(wanted.model.points(), landmark.place)});
    return extremal_sphere_map(source, sphere_map(source, options.sphere).positions, images).start;
}

/// Of surfaces with boundary, of all vertices: folds that are left when curves have gone to their partners are opened,
/// the boundary held.
Positions open_start(const Surface& source, const Surface& target, const Wanted& wanted,
                     std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                     const CurveRegistrationOptions& options) {
    std::vector<SurfaceLandmark> all(landmarks.begin(), landmarks.end());
    for (const CurvePair& pair : curves)
        for (std::size_t i = 0; i < pair.source.points.size(); ++i)
            all.push_back({nearest_vertex(pair.source.points[i]), pair.target.points[i]});
    OpenRegistrationOptions how;
    how.outer_loop = options.outer_loop;
    how.target_outer_loop = options.target_outer_loop;
    const OpenRegistration found = register_open(source, target, all, how);
    return wanted.model.at(wanted.model.points(), found.places);
}

/// Turns flipped faces on the sphere up, as far as that goes.
void turn_up(const Surface& source, const TargetConstraints& constraints, Positions& start) {
    const SphereFaces faces(source);
    if (faces.flipped(start).empty()) return;
    std::vector<int> held = constraints.fixed;
    for (const auto& slide : constraints.sliding) held.push_back(slide.vertex);
    repair_sphere_map(source, faces, start, held);
}

void open_folds(const Surface& source, const TargetConstraints& constraints, Positions& start) {
    const Eigen::VectorXcd plane = DomainModel::in_plane(start);
    if (distortion(source.operators, plane).flipped.empty()) return;
    std::vector<Freedom> freedoms(static_cast<std::size_t>(source.mesh.vertex_count()), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v]) freedoms[v] = Freedom::free;
    for (const int v : constraints.fixed) freedoms[v] = Freedom::fixed;
    for (const auto& slide : constraints.sliding) freedoms[slide.vertex] = Freedom::fixed;
    start = DomainModel::in_space(
        fold_free_map(source, freedoms, Eigen::VectorXcd::Zero(source.operators.sample_count()), plane).map);
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
    std::unique_ptr<Model> model;
    if (closed)
        model = std::make_unique<SphereModel>(target, options.sphere, result.warnings);
    else
        model = std::make_unique<DomainModel>(target, options.target_outer_loop);
    result.image = model->points();
    std::vector<CurveThrough> here, there;
    for (const CurvePair& pair : curves) {
        here.push_back(pair.source);
        there.push_back(pair.target);
    }
    Curved curved = with_curves_of(source.mesh, target.mesh, here, there);
    result.source = std::move(curved.source);
    Wanted wanted{*model, std::move(curved.target), {}, {}};
    wanted.points = model->with_places(model->points(), wanted.target.places);
    if (!options.start.empty() && static_cast<int>(options.start.size()) != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has places for another number of vertices");
    Positions start =
        !options.start.empty() ? model->at(model->points(), options.start)
        : closed               ? (curves.empty()
                                      ? start_of_landmarks(source, wanted, landmarks, options)
                                      : wanted.model.at(wanted.points, map_cut_along_curves(curved.cut_source, curved.cut_target)))
                               : open_start(source, target, wanted, landmarks, curves, options);
    if (start.rows() == source.mesh.vertex_count()) start = model->with_places(start, result.source.places);
    hold_curves(result.source, curves, wanted, start);
    hold_landmarks(landmarks, wanted, start);
    const Surface with_curves(result.source.mesh);
    result.start_flipped = model->distortion_of(with_curves, start).flipped;
    if (closed)
        turn_up(with_curves, wanted.constraints, start);
    else
        open_folds(with_curves, wanted.constraints, start);
    if (!closed) slide_boundary(wanted.constraints, with_curves, model->target(), start);
    result.map = least_lp_map(with_curves, model->target(), {options.p, {}}, wanted.constraints,
                              target_map(with_curves, model->target(), wanted.constraints, start), options.flow);
    if (const std::vector<int>& flipped = result.map.distortion.flipped; !flipped.empty())
        throw Error(Cause::not_solved,
                    std::to_string(flipped.size()) + " faces stay flipped: the start had " +
                        std::to_string(result.start_flipped.size()) + " that cannot be opened",
                    "give curves that run alike on both surfaces, fewer of them, or a start without flips",
                    {Things::faces, flipped});
    const Positions found = positions_of(result.map.map.points), own = found.topRows(source.mesh.vertex_count());
    const std::vector<MeshPoint> places = model->locate(found);
    result.places.assign(places.begin(), places.begin() + source.mesh.vertex_count());
    meet_landmarks(landmarks, result);
    result.carried.distortion = model->distortion_of(source, own);
    result.measure(source, target, result.carried.distortion.mu);
    result.curve_distance = distance_from_curves(target.mesh, places, result.source, wanted.target);
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
