// Conformal maps and maps of least distortion along surfaces, beside Wong & Zhao 2014.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/random.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/unfold/sphere_tutte.h>

#include "gallery/flow.h"
#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

/// A capsule bent by so many radians.
Mesh bent_capsule(int levels, double bend) {
    Mesh mesh = octahedral_sphere(levels);
    const double radius = 4 / bend;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d x = mesh.point(v);
        const double angle = bend * x.z();
        mesh.positions.row(v) << (radius + x.x()) * std::cos(angle) - radius, x.y(), (radius + x.x()) * std::sin(angle);
    }
    return mesh;
}

/// A machined part: an angle with a step, all its edges sharp.
Mesh angle_piece(double edge_length) {
    TargetMeshOptions sizes;
    sizes.edge_length = edge_length;
    const TargetDomain outline = target_domain(TargetCurve::polygon(
        {{-1.5, -1}, {1.5, -1}, {1.5, -.4}, {.2, -.4}, {.2, 1.2}, {-.6, 1.2}, {-.6, .2}, {-1.5, .2}}));
    const TargetMesh cap = target_mesh(outline, sizes);
    const int count = cap.mesh.vertex_count();
    const auto rim = static_cast<int>(std::count(cap.curve.begin(), cap.curve.end(), 0));
    const double thickness = 0.8;
    const int layers = std::max(1, static_cast<int>(std::lround(thickness / edge_length)));
    Mesh mesh;  // the lower cap, the upper one, and the rings between them
    mesh.positions.resize(2 * count + (layers - 1) * rim, 3);
    for (int v = 0; v < count; ++v)
        for (const int side : {0, 1})
            mesh.positions.row(side * count + v) << cap.mesh.positions.row(v), (side - 0.5) * thickness;
    for (int l = 1; l < layers; ++l)
        for (int v = 0; v < rim; ++v)
            mesh.positions.row(2 * count + (l - 1) * rim + v) << cap.mesh.positions.row(v),
                (static_cast<double>(l) / layers - 0.5) * thickness;
    for (int f = 0; f < cap.mesh.face_count(); ++f) {
        const auto face = cap.mesh.faces[f];
        mesh.faces.add({face[0], face[2], face[1]});
        mesh.faces.add({count + face[0], count + face[1], count + face[2]});
    }
    const auto at = [&](int layer, int v) {
        if (layer == 0) return v;
        return layer == layers ? count + v : 2 * count + (layer - 1) * rim + v;
    };
    for (int l = 0; l < layers; ++l)
        for (int v = 0; v < rim; ++v) {
            const int next = (v + 1) % rim;
            mesh.faces.add({at(l, v), at(l, next), at(l + 1, next)});
            mesh.faces.add({at(l, v), at(l + 1, next), at(l + 1, v)});
        }
    return mesh;
}

void unfold(Output& output, Figure& figure, Table& table, const std::string& name, const Mesh& whole, double azimuth,
            double elevation) {
    const Surface source(remove_unreferenced(whole).mesh);
    const int count = source.mesh.vertex_count();
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
    for (int s = 0; s < source.operators.sample_count(); ++s)
        for (const int v : source.operators.stencil(s)) weights[v] += source.operators.weights[s];
    Positions radial = source.mesh.positions;
    radial.rowwise() -= Eigen::RowVector3d((weights.transpose() * radial) / weights.sum());
    const std::optional<Positions> tutte = sphere_tutte(source, tutte_roots(source, 1)[0], weights);
    const SphereTarget target;
    const Eigen::VectorXcd conformal = Eigen::VectorXcd::Zero(source.operators.sample_count());
    for (const bool from_tutte : {false, true}) {
        const TargetMap begin = target_map(source, target, {}, from_tutte ? *tutte : radial);
        const Distortion before = distortion(source.operators, positions_of(begin.points), normals_of(begin.points));
        for (const FlowScheme scheme : {FlowScheme::automatic, FlowScheme::perturbation}) {
            SurfaceFlowOptions options;
            options.scheme = scheme;
            const double start = seconds_now();
            const SurfaceFlowMap flow = surface_flow(source, target, conformal, {}, begin, options);
            std::vector<std::string> row{name, std::to_string(source.mesh.face_count()),
                                         from_tutte ? "Tutte" : "radial", std::to_string(before.flipped.size()),
                                         to_string(scheme)};
            for (std::string& cell : numbers_of(flow, seconds_now() - start)) row.push_back(std::move(cell));
            table.rows.push_back(std::move(row));
            if (from_tutte || scheme != FlowScheme::automatic) continue;
            Picture picture{"flow_" + name, name + ", and its image from an overlapping start.", {}};
            const Positions image = positions_of(flow.map.points);
            add_views(output, picture, "flow_" + name, source.mesh, image, seen_from_south(image),
                      flow.distortion.face_abs_mu, "checker", azimuth, elevation);
            figure.pictures.push_back(std::move(picture));
        }
    }
    const double start = seconds_now();
    const SphereMap uniform = sphere_map(source);
    const Distortion& d = uniform.distortion;
    table.rows.push_back({name, std::to_string(source.mesh.face_count()), "none", "", "uniformization",
                          std::to_string(uniform.iterations), number(d.mean), number(d.standard_deviation),
                          number(d.max), std::to_string(d.flipped.size()), number(seconds_now() - start, 2)});
}

}  // namespace

Figure flow_unfolding(Output& output) {
    Figure figure{"Figures 5.5 to 5.8: conformal maps to the sphere from overlapping starts",
                  "The start is the projection from the centroid, which overlaps, or Tutte's map, which does not. The "
                  "paper's fandisk is not at hand; the angle piece is another part with sharp edges."};
    Table table{
        "Nothing is held. Automatic: residual steps while faces are flipped, then perturbations, then against a "
        "barrier",
        {"mesh", "faces", "start", "flipped there", "steps by", "steps", "mean abs(μ)", "std", "max", "flips",
         "seconds"},
        {}};
    unfold(output, figure, table, "angle_piece", angle_piece(0.06), 30, 45);
    unfold(output, figure, table, "bent_capsule", bent_capsule(5, 1.4), 30, 20);
    for (const auto& [name, azimuth, elevation] : {std::tuple{"hippocampus.obj", 30.0, 20.0},
                                                   {"hand_closed.obj", -90.0, 70.0},
                                                   {"fish_quad.obj", 60.0, 20.0},
                                                   {"cow.off", -75.0, 70.0}})
        if (const auto path = scan_path(name)) {
            Mesh mesh = read_mesh(*path).mesh;
            unfold(output, figure, table, path->stem().string(), mesh, azimuth, elevation);
        }
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure flow_tori(Output& output) {
    Figure figure{"Figures 5.12 and 5.13: least Lᵖ norm onto the modified tori",
                  "The torus of radii 2 and 1 in a jittered grid of 80 × 40 cells, onto the two modified tori of the "
                  "paper, which takes its kitten; p = 3 "
                  "and 4 are theirs. Start: equal parameters. By the area of the surface no p gives the extremal map; "
                  "by the area |φ| of "
                  "the flat metric already p = 2 does."};
    Table table{"k of the extremal map: .0929 and .2321; |μ| over the area of the source",
                {"target", "weight", "p", "steps", "mean abs(μ)", "std", "max", "flips", "seconds"},
                {}};
    constexpr int kAround = 80, kAcross = 40;
    Mesh mesh = torus(2, 1, kAround, kAcross);
    const ParametricTarget round = torus_target(2, 1);
    Eigen::VectorXcd plane(mesh.vertex_count());
    Random random(1);
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const Complex w((i + random.uniform(-0.2, 0.2)) / kAround, (j + random.uniform(-0.2, 0.2)) / kAcross);
            plane[kAcross * i + j] = w;
            mesh.positions.row(kAcross * i + j) = round.at(w.real(), w.imag()).position;
        }
    const Surface source(mesh);
    const std::vector<double> phi = flat_areas(flat_torus(source), mesh.faces);
    for (const int which : {1, 2}) {
        const ParametricTarget target = which == 1 ? first_modified_torus() : second_modified_torus();
        TargetMap begin;
        for (const Complex w : plane) begin.points.push_back(target.at(w.real(), w.imag()));
        for (const bool by_phi : {false, true})
            for (const double p : {2.0, 3.0, 4.0, 8.0}) {
                const double start = seconds_now();
                const SurfaceFlowMap flow =
                    least_lp_map(source, target, {p, by_phi ? phi : std::vector<double>{}}, {}, begin);
                std::vector<std::string> row{which == 1 ? "first" : "second", by_phi ? "abs(φ)" : "area", number(p, 0)};
                for (std::string& cell : numbers_of(flow, seconds_now() - start)) row.push_back(std::move(cell));
                table.rows.push_back(std::move(row));
                if (by_phi != (which == 2) || p != (which == 1 ? 3 : 4)) continue;
                const std::string name = "flow_torus_" + std::to_string(which);
                Picture picture{name, which == 1 ? "L³ by area onto the first." : "L⁴ by |φ| onto the second.", {}};
                Eigen::VectorXcd waves = plane;
                for (Complex& w : waves)
                    w = {std::sin(2 * std::numbers::pi * w.real()), std::sin(2 * std::numbers::pi * w.imag())};
                add_views(output, picture, name, mesh, positions_of(flow.map.points), waves,
                          flow.distortion.face_abs_mu, "mu", 30, 45);
                figure.pictures.push_back(std::move(picture));
            }
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
