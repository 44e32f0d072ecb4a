#include <beltrami/uniformize/sphere_map.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/solve/raised_corners.h>
#include <beltrami/solve/sphere_barrier.h>
#include <beltrami/sphere/centring.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/sphere_faces.h>
#include <beltrami/unfold/sphere_repair.h>
#include <beltrami/unfold/sphere_tutte.h>
#include <beltrami/uniformize/ideal_sphere.h>
#include <beltrami/uniformize/triangle_metric.h>

namespace beltrami {

namespace {

constexpr int kMostIdealVertices = 3, kMostBarrierSteps = 60;
constexpr int kMostRoots = 8, kRootFaces = 5000;  // more roots on small meshes: up to so many faces in all
constexpr double kBarrierSettled = 1e-2;          // relative fall of the energy in a step that is nearly full
constexpr double kBarrierFull = 0.4;
constexpr double kUnresolved = 1e-13;
constexpr double kOffCentre = 1e-6;

class Mapping {
  public:
    Mapping(const Surface& source, const SphereMapOptions& options)
        : source_(source), options_(options), faces_(source), areas_(vertex_areas(source.operators)) {}

    SphereMap run() {
        bool found = false;
        result_.method = options_.method;
        switch (options_.method) {
            case SphereMethod::conformal_equivalence:
                found = equivalent();
                break;
            case SphereMethod::least_distortion:
                found = least_distortion();
                break;
            case SphereMethod::tutte:
                found = tutte();
                break;
        }
        if (!found && options_.fall_back && options_.method != SphereMethod::least_distortion) {
            const std::string reason = failure_;
            result_.log_scale.resize(0);
            found = least_distortion();
            result_.method = SphereMethod::least_distortion;
            result_.route = SphereRoute::fallback;
            if (found)
                result_.warnings.push_back(
                    {WarningKind::fallback, "the map of least distortion on this mesh was taken instead: " + reason});
        }
        if (!found && !accept_turned_in()) refuse();
        finish();
        return std::move(result_);
    }

  private:
    /// Discrete uniformization, drawn with the surface's own faces. @return whether none is flipped
    bool equivalent() {
        const TriangleMetric metric = triangle_metric(
            source_.mesh, source_.topology, source_.metric ? *source_.metric : corner_positions(source_.mesh));
        IntrinsicTriangulation triangulation(metric.triangles, source_.mesh.vertex_count(), metric.log_lengths);
        result_.lengthened = metric.lengthened;
        result_.flips = triangulation.make_delaunay();
        std::vector<int> candidates = ideal_candidates(triangulation, source_.mesh.positions);
        if (options_.ideal_vertex) {
            if (std::ranges::find(candidates, *options_.ideal_vertex) == candidates.end())
                throw Error(Cause::bad_option,
                            "vertex " + std::to_string(*options_.ideal_vertex) +
                                " cannot be sent to infinity: its star touches itself, or it is none of the surface",
                            "choose another one, or none", {Things::vertices, {*options_.ideal_vertex}});
            candidates = {*options_.ideal_vertex};
        }
        if (candidates.empty()) {
            failure_ = "no vertex has a star that does not touch itself";
            return false;
        }
        std::vector<char> used(static_cast<std::size_t>(source_.mesh.vertex_count()), 0);
        for (const int v : source_.mesh.faces.vertices()) used[v] = 1;
        if (candidates.size() > kMostIdealVertices) candidates.resize(kMostIdealVertices);
        for (const int ideal : candidates) {
            try {
                const IdealSphere sphere =
                    ideal_sphere(triangulation, ideal, used, options_.tolerance, options_.max_iterations);
                count(sphere, ideal);
                if (sphere.solved()) return draw(sphere);
                failure_ = "the scale factors did not converge, with an angle defect of " +
                           std::to_string(sphere.factors.residual);
            } catch (const Error& error) {
                if (error.cause() != Cause::not_solved) throw;
                failure_ = error.what();
            }
        }
        return false;
    }

    void count(const IdealSphere& sphere, int ideal) {
        result_.iterations += sphere.factors.iterations;
        result_.factorizations += sphere.factors.factorizations;
        result_.flips += sphere.factors.flips;
        result_.residual = sphere.factors.residual;
        result_.layout_error = sphere.layout_error;
        result_.ideal_vertex = ideal;
    }

    bool draw(const IdealSphere& sphere) {
        Eigen::VectorXd weights = areas_;
        weights[*result_.ideal_vertex] = 0;
        Positions points = sphere_points(around_median(sphere.plane, weights));
        points.row(*result_.ideal_vertex) << 0, 0, -1;
        result_.log_scale = sphere.factors.u;
        result_.log_scale[*result_.ideal_vertex] = 0;
        return settle(centred(std::move(points), areas_));
    }

    /// Turns flipped faces up. @return whether none is left
    bool settle(const CentredSphere& sphere) {
        result_.positions = sphere.points;
        result_.centre_distance = sphere.centre_distance;
        const SphereRepair repair = repair_sphere_map(source_, faces_, result_.positions);
        result_.moved =
            static_cast<int>(((result_.positions - sphere.points).rowwise().squaredNorm().array() > 0).count());
        if (repair.unfolded > 0)
            result_.route = SphereRoute::unfolded;
        else if (repair.averaged > 0)
            result_.route = SphereRoute::averaged;
        if (repair.flipped.empty()) return true;
        failure_ = counted(repair.flipped.size(), "face stays", "faces stay") + " flipped between the conformal images";
        keep_best(repair.flipped);
        if (!turned_in_ && faces_.upright_as_triangles(result_.positions) &&
            distortion(source_.operators, result_.positions, result_.positions).flipped.empty())
            turned_in_ = result_;
        return false;
    }

    /// The first map found whose quads turn in at corners but do not fold where they are measured.
    bool accept_turned_in() {
        if (!turned_in_) return false;
        Warnings warnings = std::move(result_.warnings);
        result_ = std::move(*turned_in_);
        result_.warnings = std::move(warnings);
        const std::vector<int> turned_in = faces_.flipped(result_.positions);
        result_.warnings.push_back({WarningKind::turned_in,
                                    std::to_string(turned_in.size()) +
                                        " quads turn in at a corner on the sphere; as triangles none is flipped",
                                    {Things::faces, turned_in}});
        return true;
    }

    /// Remembers the map with the fewest flipped faces for what is said of a failure.
    void keep_best(const std::vector<int>& flipped) {
        if (!best_flipped_.empty() && best_flipped_.size() <= flipped.size()) return;
        best_flipped_ = flipped;
        best_ = result_.positions;
    }

    /// Tutte's sphere from the first root that leaves no geodesic triangle flipped.
    bool tutte() {
        const int most_roots = std::max(kMostRoots, kRootFaces / source_.mesh.face_count());
        for (const int root : tutte_roots(source_, most_roots)) {
            std::optional<Positions> points = sphere_tutte(source_, root, areas_);
            ++result_.factorizations;
            if (!points) continue;
            result_.positions = std::move(*points);
            const std::vector<int> flipped = faces_.flipped(result_.positions);
            result_.moved = 0;
            if (flipped.empty()) return true;
            if (settle(centred(result_.positions, areas_))) return true;
        }
        if (failure_.empty()) failure_ = "Tutte's system is singular to rounding";
        return false;
    }

    /// From Tutte's sphere down the barrier energy. Stops early: it falls for ever along Möbius maps, which chordal
    /// triangles are not invariant under.
    bool least_distortion() {
        if (!tutte()) return false;
        std::vector<Freedom> freedoms(static_cast<std::size_t>(source_.mesh.vertex_count()), Freedom::fixed);
        for (const int v : source_.mesh.faces.vertices()) freedoms[v] = Freedom::free;
        const Operators raised = operators_from_corners(source_.mesh, raised_corners(source_));
        SphereBarrier barrier(raised, std::move(freedoms), Eigen::VectorXcd::Zero(raised.sample_count()),
                              source_.operators.weights);
        Positions points = result_.positions;
        if (!std::isfinite(barrier.value(points))) {
            failure_ = "Tutte's sphere is folded to rounding";
            return false;
        }
        for (int step = 0; step < kMostBarrierSteps; ++step) {
            SphereBarrier::Taken taken;
            try {
                taken = barrier.step(points);
            } catch (const Error& error) {
                if (error.cause() != Cause::not_solved) throw;
                break;
            }
            ++result_.iterations;
            const bool full = taken.length > kBarrierFull && !taken.damped;
            if (taken.length == 0 || (full && taken.fallen < kBarrierSettled)) break;
        }
        result_.factorizations += barrier.factorization_count();
        CentredSphere sphere = centred(points, areas_);
        if (faces_.flipped(sphere.points).empty()) return settle(sphere);
        const double off_centre = (areas_.transpose() * points).norm() / areas_.sum();
        return settle({std::move(points), off_centre, 0});
    }

    /// Faces with an edge that is too short in the map, and their share of the area.
    void find_unresolved(const Positions& points) {
        std::vector<double> areas(static_cast<std::size_t>(source_.mesh.face_count()), 0.0);
        for (int s = 0; s < source_.operators.sample_count(); ++s)
            areas[source_.operators.faces[s]] += source_.operators.weights[s];
        result_.unresolved.clear();
        result_.unresolved_area = 0;
        for (int f = 0; f < source_.mesh.face_count(); ++f) {
            const auto v = source_.mesh.faces[f];
            double shortest = 2;
            for (std::size_t i = 0; i < v.size(); ++i)
                shortest = std::min(shortest, (points.row(v[(i + 1) % v.size()]) - points.row(v[i])).norm());
            if (shortest >= kUnresolved) continue;
            result_.unresolved.push_back(f);
            result_.unresolved_area += areas[f];
        }
        result_.unresolved_area /= source_.operators.area();
    }

    std::string unresolved_sentence() const {
        char percent[32];
        std::snprintf(percent, sizeof percent, "%.3g", 100 * result_.unresolved_area);
        return counted(result_.unresolved.size(), "face (", "faces (") + percent + " % of the area) " +
               (result_.unresolved.size() == 1 ? "has" : "have") +
               " edges below 1e-13 of the sphere's radius, which double precision does not resolve";
    }

    [[noreturn]] void refuse() {
        std::string sentence = "no map to the sphere without flipped faces was found: " + failure_;
        if (best_.size() > 0) {
            find_unresolved(best_);
            if (!result_.unresolved.empty()) sentence += "; " + unresolved_sentence();
        }
        throw Error(Cause::not_solved, sentence,
                    result_.unresolved.empty() ? "refine the mesh where these faces are"
                                               : "cut thin limbs off, or map them on their own",
                    {Things::faces, best_flipped_});
    }

    void finish() {
        for (int v = 0; v < source_.mesh.vertex_count(); ++v)
            if (!(areas_[v] > 0)) result_.positions.row(v) << 0, 0, 1;
        result_.distortion = distortion(source_.operators, result_.positions, result_.positions);
        if (const std::vector<int>& flipped = result_.distortion.flipped; !flipped.empty())
            result_.warnings.push_back(
                {WarningKind::turned_in,
                 std::to_string(flipped.size()) + " faces, the first is face " + std::to_string(flipped[0]) +
                     ", keep their orientation on the sphere, but not at every point where |mu| is "
                     "measured: they are quads that turn in, or nearly collapsed",
                 {Things::faces, flipped}});
        find_unresolved(result_.positions);
        if (!result_.unresolved.empty())
            result_.warnings.push_back(
                {WarningKind::unresolved_faces, unresolved_sentence(), {Things::faces, result_.unresolved}});
        if (result_.moved > 0)
            result_.warnings.push_back(
                {WarningKind::unfolded, std::to_string(result_.moved) +
                                            " vertices were moved to turn faces up that came out flipped between the "
                                            "conformal images"});
        if (result_.centre_distance > kOffCentre)
            result_.warnings.push_back({WarningKind::off_centre,
                                        "the centre of mass is off the sphere's centre: nearly half of the surface "
                                        "comes to one point"});
    }

    const Surface& source_;
    const SphereMapOptions& options_;
    const SphereFaces faces_;
    const Eigen::VectorXd areas_;
    SphereMap result_;
    std::string failure_;
    std::vector<int> best_flipped_;
    Positions best_;
    std::optional<SphereMap> turned_in_;
};

}  // namespace

const char* to_string(SphereMethod method) {
    switch (method) {
        case SphereMethod::conformal_equivalence:
            return "conformal_equivalence";
        case SphereMethod::least_distortion:
            return "least_distortion";
        case SphereMethod::tutte:
            return "tutte";
    }
    return "";
}

const char* to_string(SphereRoute route) {
    switch (route) {
        case SphereRoute::direct:
            return "direct";
        case SphereRoute::averaged:
            return "averaged";
        case SphereRoute::unfolded:
            return "unfolded";
        case SphereRoute::fallback:
            return "fallback";
    }
    return "";
}

void SphereMapOptions::validate() const {
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        throw Error(Cause::bad_option, "the tolerance of the sphere map is not positive", "1e-10 is usual");
    if (max_iterations < 1) throw Error(Cause::bad_option, "the sphere map is allowed no iterations", "200 is usual");
}

void require_sphere(const Surface& source) {
    const Topology& shape = source.topology;
    if (shape.components != 1)
        throw Error(Cause::bad_mesh, "the surface has " + std::to_string(shape.components) + " components",
                    "map them to spheres one at a time");
    if (!shape.boundary_loops.empty())
        throw Error(Cause::bad_mesh,
                    "the surface is open, with " + std::to_string(shape.boundary_loops.size()) +
                        " boundary loops, and only a closed one goes to the sphere",
                    "fill its holes, or map it to a disk", {Things::vertices, shape.boundary_loops[0]});
    if (shape.genus != 0)
        throw Error(Cause::bad_mesh,
                    "the surface has genus " + std::to_string(shape.genus) + " and the sphere has none",
                    "remove its handles, or cut it open");
}

SphereMap sphere_map(const Surface& source, const SphereMapOptions& options) {
    options.validate();
    require_sphere(source);
    return Mapping(source, options).run();
}

SphereMap sphere_map(const Mesh& polygons, const SphereMapOptions& options) {
    SplitMesh split = split_unusable_faces(polygons);
    const auto renamed = [&](std::vector<int> faces) {
        for (int& f : faces) f = split.faces[f];
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        return faces;
    };
    SphereMap result;
    try {
        result = sphere_map(Surface(std::move(split.mesh)), options);
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
        throw Error(Cause::not_solved, error.what(), "", {Things::faces, renamed(error.indices())});
    }
    result.unresolved = renamed(std::move(result.unresolved));
    for (Warning& warning : result.warnings)
        if (warning.where.of == Things::faces) warning.where.indices = renamed(std::move(warning.where.indices));
    return result;
}

}  // namespace beltrami
