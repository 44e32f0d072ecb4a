#include <beltrami/registration/register_curves.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/registration/curve_start.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/unfold/sphere_faces.h>

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

/// A map of vertices with those that curves add.
Positions with_places(const Positions& sphere, std::span<const MeshPoint> places) {
    Positions result(sphere.rows() + static_cast<Eigen::Index>(places.size()), 3);
    result.topRows(sphere.rows()) = sphere;
    for (std::size_t i = 0; i < places.size(); ++i)
        result.row(sphere.rows() + static_cast<Eigen::Index>(i)) = sphere_place(sphere, places[i]);
    return result;
}

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

/// The target's sphere with its curves, and what the source's curves have to keep to.
struct Wanted {
    MeshWithCurves target;
    Positions sphere;  ///< of the target's vertices with those of the curves
    TargetConstraints constraints;
};

Eigen::Vector3d partner_point(const Wanted& wanted, const MeshWithCurves& source, std::size_t c, std::size_t i) {
    const auto& partner = wanted.target.curves[c];
    const auto [segment, part] = partner_place(source.curves[c], i, partner);
    const int a = partner.vertices[segment], b = partner.vertices[(segment + 1) % partner.vertices.size()];
    return ((1 - part) * wanted.sphere.row(a) + part * wanted.sphere.row(b)).normalized();
}

/// Fixes and lets slide what curves hold; fixed vertices are put where they stay.
void hold_curves(const MeshWithCurves& source, std::span<const CurvePair> curves, Wanted& wanted, Positions& start) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const auto& chain = source.curves[c];
        const auto& partner = wanted.target.curves[c];
        const auto curve = static_cast<int>(wanted.constraints.curves.size());
        if (curves[c].slides)
            wanted.constraints.curves.push_back(
                std::make_shared<SphereCurve>(wanted.sphere(partner.vertices, Eigen::all), partner.closed));
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
void hold_landmarks(std::span<const SurfaceLandmark> landmarks, const Positions& target_sphere, Wanted& wanted,
                    Positions& start) {
    for (const SurfaceLandmark& landmark : landmarks) {
        const auto on_curve = std::find_if(wanted.constraints.sliding.begin(), wanted.constraints.sliding.end(),
                                           [&](const auto& slide) { return slide.vertex == landmark.vertex; });
        const bool fixed = std::find(wanted.constraints.fixed.begin(), wanted.constraints.fixed.end(),
                                     landmark.vertex) != wanted.constraints.fixed.end();
        if (fixed || on_curve != wanted.constraints.sliding.end())
            throw Error(Cause::bad_boundary, "landmark " + std::to_string(landmark.vertex) + " lies on a curve",
                        "leave it out, and name it as a point of the curve", {Things::vertices, {landmark.vertex}});
        wanted.constraints.fixed.push_back(landmark.vertex);
        start.row(landmark.vertex) = sphere_place(target_sphere, landmark.place);
    }
}

/// Largest distance in space of a vertex of a curve from its partner.
double distance_from_curves(const Mesh& target, const Positions& sphere, const Positions& found,
                            const MeshWithCurves& source, const MeshWithCurves& on_target) {
    const SphereLocator locator(target.faces, sphere);
    double largest = 0;
    for (std::size_t c = 0; c < source.curves.size(); ++c) {
        const auto& partner = on_target.curves[c];
        const PolylineCurve curve(on_target.mesh.positions(partner.vertices, Eigen::all), partner.closed);
        for (const int v : source.curves[c].vertices) {
            const MeshPoint place = locator.locate(Eigen::Vector3d(found.row(v)));
            Eigen::Vector3d point = Eigen::Vector3d::Zero();
            for (int i = 0; i < 3; ++i) point += place.barycentric[i] * target.point(place.vertices[i]);
            largest = std::max(largest, (point - curve.point(curve.nearest(point))).norm());
        }
    }
    return largest;
}

}  // namespace

LpRegistration register_least_lp(const Surface& source, const Surface& target,
                                 std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                                 const CurveRegistrationOptions& options) {
    require_pairs(landmarks, curves);
    require_sphere(source);
    require_sphere(target);
    LpRegistration result;
    result.target_sphere = sphere_map(target, options.sphere);
    const Positions& sphere = result.target_sphere.positions;
    std::vector<CurveThrough> here, there;
    for (const CurvePair& pair : curves) {
        here.push_back(pair.source);
        there.push_back(pair.target);
    }
    result.source = of_surface("source", source.mesh, here);
    Wanted wanted{of_surface("target", target.mesh, there), {}, {}};
    wanted.sphere = with_places(sphere, wanted.target.places);
    Positions start(source.mesh.vertex_count(), 3);
    if (!options.start.empty()) {
        if (static_cast<int>(options.start.size()) != source.mesh.vertex_count())
            throw Error(Cause::bad_option, "the start has places for another number of vertices");
        for (int v = 0; v < source.mesh.vertex_count(); ++v) start.row(v) = sphere_place(sphere, options.start[v]);
        start = with_places(start, result.source.places);
    } else if (!curves.empty()) {
        start.resize(result.source.mesh.vertex_count(), 3);
        const std::vector<MeshPoint> places = map_cut_along_curves(result.source, wanted.target);
        for (std::size_t v = 0; v < places.size(); ++v)
            start.row(static_cast<Eigen::Index>(v)) = sphere_place(wanted.sphere, places[v]);
    } else {
        std::vector<SphereLandmark> images;
        for (const SurfaceLandmark& landmark : landmarks)
            images.push_back({landmark.vertex, sphere_place(sphere, landmark.place)});
        start = extremal_sphere_map(source, sphere_map(source, options.sphere).positions, images).start;
    }
    hold_curves(result.source, curves, wanted, start);
    hold_landmarks(landmarks, sphere, wanted, start);
    const Surface with_curves(result.source.mesh);
    result.start_flipped = SphereFaces(with_curves).flipped(start);
    const SphereTarget onto;
    result.map = least_lp_map(with_curves, onto, {options.p, {}}, wanted.constraints,
                              target_map(with_curves, onto, wanted.constraints, start), options.flow);
    const Positions found = positions_of(result.map.map.points);
    const Positions own = found.topRows(source.mesh.vertex_count());
    result.places = SphereLocator(target.mesh.faces, sphere).locate(own);
    meet_landmarks(landmarks, result);
    result.carried.distortion = distortion(source.operators, own, own);
    result.measure(source, target, result.carried.distortion.mu);
    result.curve_distance = distance_from_curves(target.mesh, sphere, found, result.source, wanted.target);
    append(result.warnings, result.target_sphere.warnings);
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
