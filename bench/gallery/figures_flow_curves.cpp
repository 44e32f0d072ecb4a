// Maps of least distortion that take curves to curves, beside Wong & Zhao 2014.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <beltrami/mesh/submesh.h>
#include <beltrami/registration/held_curves.h>
#include <beltrami/registration/natural_start.h>

#include "gallery/flow.h"
#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

using Directions = std::vector<Eigen::Vector3d>;

/// A sphere in folds, with a cleft between two halves: the shape of a cortex, and with its narrow furrows.
Mesh brain(int levels) {
    Mesh mesh = icosahedral_sphere(levels);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d x = mesh.point(v);
        const double warp = 1.4 * std::sin(3 * x.y() + 2 * x.z()) + 1.1 * std::sin(4 * x.z() - 3 * x.x());
        const double folds = std::tanh(2 * std::sin(11 * x.y() + 3 * warp) + std::cos(9 * x.z() - 2 * warp));
        const double cleft = 0.3 * std::exp(-std::pow(x.x() / 0.09, 2)) * std::max(0.0, x.z() + 0.4);
        const double r = 1 + 0.07 * folds - cleft;
        mesh.positions.row(v) << 0.95 * r * x.x(), 1.2 * r * x.y(), 0.85 * r * x.z();
    }
    return mesh;
}

/// The vertices that lie farthest in some directions from a point.
CurveThrough curve_through(const Mesh& mesh, const Directions& directions) {
    const Eigen::Vector3d middle = mesh.positions.colwise().mean().transpose();
    CurveThrough curve;
    for (const Eigen::Vector3d& direction : directions) {
        const Eigen::Vector3d way = direction.normalized();
        int best = 0;
        double most = -1e300;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Eigen::Vector3d from = mesh.point(v) - middle;
            const double along = from.dot(way) - 3 * (from - from.dot(way) * way).norm();
            if (along > most) most = along, best = v;
        }
        curve.points.push_back(place_of_vertex(mesh, best));
    }
    return curve;
}

/// On the great circle between two points, as many as a curve has and at its parts of the arc.
Target::Points along_arc(const SphereTarget& sphere, const CurveThrough& curve, const Mesh& mesh,
                         const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const MeshWithCurves with_curve = mesh_with_curves(mesh, std::array{curve});
    const MeshWithCurves::Chain& chain = with_curve.curves[0];
    const double angle = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
    Target::Points points;
    for (const int given : chain.given) {
        const double t = chain.lengths[given] / chain.length;
        points.push_back(sphere.nearest(std::sin((1 - t) * angle) * from + std::sin(t * angle) * to));
    }
    return points;
}

/// Of a chain of vertices on the sphere: how far they are from its great circle.
double off_great_circle(const Positions& images, const MeshWithCurves::Chain& chain) {
    const Eigen::Vector3d normal =
        Eigen::Vector3d(images.row(chain.vertices.front())).cross(Eigen::Vector3d(images.row(chain.vertices.back())));
    double largest = 0;
    for (const int v : chain.vertices)
        largest = std::max(largest, std::abs(Eigen::Vector3d(images.row(v)).dot(normal.normalized())));
    return largest;
}

std::vector<std::vector<int>> chains_of(const MeshWithCurves& source) {
    std::vector<std::vector<int>> chains;
    for (const MeshWithCurves::Chain& chain : source.curves) chains.push_back(chain.vertices);
    return chains;
}

/// A flow along curves, of a surface divided along them.
struct AlongCurves {
    HeldCurves held;
    Surface divided;
    SurfaceFlowMap flow;
    int flipped_at_start;
    double seconds;
};

AlongCurves flow_along_curves(const Surface& source, const Target& target, const TargetKind& kind,
                              const std::vector<CurveOnto>& curves) {
    const double begun = seconds_now();
    HeldCurves held = held_curves(source.mesh, target, curves, natural_start(source, target, kind, curves));
    Surface divided(held.source.mesh);
    LedMap led = led_start(divided, target, held);
    const int flipped = led.flips;
    SurfaceFlowMap flow = least_lp_map(divided, target, {2, {}}, held.constraints, std::move(led.map));
    return {std::move(held), std::move(divided), std::move(flow), flipped, seconds_now() - begun};
}

void onto_sphere(Output& output, Figure& figure, Table& table, const std::string& name, const Surface& source,
                 const std::vector<CurveOnto>& curves, double azimuth, double elevation) {
    const SphereTarget sphere;
    const auto [held, divided, flow, flipped_at_start, seconds] = flow_along_curves(source, sphere, {}, curves);
    const Positions image = positions_of(flow.map.points), free = sphere_map(divided).positions;
    double off = 0, off_free = 0;
    for (const MeshWithCurves::Chain& chain : held.source.curves) {
        off = std::max(off, off_great_circle(image, chain));
        off_free = std::max(off_free, off_great_circle(free, chain));
    }
    std::vector<std::string> row{name, std::to_string(source.mesh.face_count()), "sphere",
                                 std::to_string(curves.size()), std::to_string(flipped_at_start)};
    for (std::string& cell : numbers_of(flow, seconds)) row.push_back(std::move(cell));
    row.push_back(scientific(off_free));
    row.push_back(scientific(off));
    table.rows.push_back(std::move(row));
    Picture picture{"flow_curves_" + name,
                    name + " with " + (curves.size() == 1 ? "a curve" : "three curves") +
                        ", the conformal map and the one that takes them to arcs of great circles.",
                    {}};
    add_views(output, picture, "flow_curves_" + name, divided.mesh, image, seen_from_south(image),
              flow.distortion.face_abs_mu, "checker", azimuth, elevation, chains_of(held.source));
    Mesh there = divided.mesh;
    there.positions = free;
    const std::string data = output.write("flow_curves_" + name + "_free", there, seen_from_south(free),
                                          sphere_map(divided).distortion.face_abs_mu);
    picture.panels.insert(picture.panels.begin() + 1, surface_panel(data, "conformal", "checker", azimuth, elevation,
                                                                    20, 1, chains_of(held.source)));
    figure.pictures.push_back(std::move(picture));
}

/// Three curves of a cortex: two beside the cleft and one across the front.
std::vector<CurveOnto> curves_of_brain(const Surface& source) {
    const SphereTarget sphere;
    const Positions free = sphere_map(source).positions;
    std::vector<CurveOnto> curves;
    for (const Directions& through : {Directions{{.6, .7, .5}, {.75, .3, .65}, {.6, -.2, .8}, {.7, -.6, .5}},
                                      Directions{{-.6, .7, .5}, {-.75, .3, .65}, {-.6, -.2, .8}, {-.7, -.6, .5}},
                                      Directions{{.5, .85, -.3}, {.1, .95, -.2}, {-.5, .85, -.3}}}) {
        CurveOnto curve{curve_through(source.mesh, through), {}, true};
        const int from = nearest_vertex(curve.source.points.front()), to = nearest_vertex(curve.source.points.back());
        curve.target = along_arc(sphere, curve.source, source.mesh, free.row(from), free.row(to));
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// A scan onto another one, with so many curves between points that their landmarks name.
void onto_scan(Table& table, const Surface& source, const Surface& onto, const std::vector<CurveOnto>& curves,
               const MeshTarget& target) {
    const AlongCurves found = flow_along_curves(source, target, {&onto}, curves);
    double off = 0;
    for (const TargetConstraints::Slide& slide : found.held.constraints.sliding) {
        const SlideCurve& partner = *found.held.constraints.curves[slide.curve];
        const Eigen::Vector3d point = found.flow.map.points[slide.vertex].position;
        off = std::max(off, (partner.point(partner.nearest(point)) - point).norm());
    }
    std::vector<std::string> row{"hand_closed", std::to_string(source.mesh.face_count()), "hippocampus",
                                 std::to_string(curves.size()), std::to_string(found.flipped_at_start)};
    for (std::string& cell : numbers_of(found.flow, found.seconds)) row.push_back(std::move(cell));
    row.insert(row.end(), {"", scientific(off)});
    table.rows.push_back(std::move(row));
}

}  // namespace

Figure flow_curves(Output& output) {
    Figure figure{
        "Figures 5.10 and 5.11: curves that go to curves",
        "The paper maps the Stanford bunny to the sphere with one curve held, and a cortex with three that go "
        "to geodesics. Here the closed bunny and a cortex that is made of folds; curves slide along their "
        "partners, only their ends stay. The start is cut along the curves."};
    Table table{
        "Least L² norm of μ by area. Off: largest distance of a curve's vertex from the great circle of its ends, "
        "in the conformal map and in this one; onto a scan the largest distance from the partner",
        {"mesh", "faces", "onto", "curves", "flipped at the start", "steps", "mean abs(μ)", "std", "max", "flips",
         "seconds", "off, conformal", "off"},
        {}};
    if (const std::filesystem::path bunny = "out/bunny_closed.obj"; std::filesystem::exists(bunny)) {
        const Surface source(remove_unreferenced(read_mesh(bunny).mesh).mesh);
        CurveOnto curve{curve_through(source.mesh, {{-.6, .8, .3}, {0, 1, -.2}, {.7, .5, -.2}, {1, -.3, 0}}), {}, true};
        const SphereTarget sphere;
        curve.target = along_arc(sphere, curve.source, source.mesh, {0, -std::sin(.9), std::cos(.9)},
                                 {0, std::sin(.9), std::cos(.9)});
        onto_sphere(output, figure, table, "bunny_closed", source, {curve}, -80, 65);
    }
    const Surface cortex(brain(5));
    onto_sphere(output, figure, table, "brain", cortex, curves_of_brain(cortex), 60, 50);
    const auto hand = scan_path("hand_closed.obj"), hippocampus = scan_path("hippocampus.obj");
    if (hand && hippocampus) {
        const Surface source(read_mesh(*hand).mesh), target(read_mesh(*hippocampus).mesh);
        const MeshTarget along(target.mesh);
        std::vector<CurveOnto> curves;
        for (const auto& [a, b, c, d] :
             {std::array{315, 5862, 742, 691}, {2755, 5206, 3696, 3896}, {6691, 6400, 3990, 243}}) {
            curves.push_back({{{place_of_vertex(source.mesh, a), place_of_vertex(source.mesh, b)}, false},
                              {along.at_vertex(c), along.at_vertex(d)},
                              true});
            onto_scan(table, source, target, curves, along);
        }
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
