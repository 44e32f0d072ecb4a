#include <beltrami/base/constants.h>
#include <beltrami/uniformize/sphere_map.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/sphere/centring.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/sphere_faces.h>
#include <beltrami/uniformize/ideal_sphere.h>
#include <beltrami/uniformize/triangle_metric.h>

#include "support/real_mesh.h"
#include "support/revolution.h"

namespace beltrami {
namespace {

/// Distances of two sets of points after the best rotation, weighted.
Eigen::VectorXd distances_up_to_rotation(const Positions& a, const Positions& b, const Eigen::VectorXd& weights) {
    const Eigen::Matrix3d moment = b.transpose() * weights.asDiagonal() * a;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    return (a * rotation.transpose() - b).rowwise().norm();
}

void expect_one_to_one(const Surface& surface, const SphereMap& map) {
    EXPECT_TRUE(SphereFaces(surface).flipped(map.positions).empty());
    EXPECT_TRUE(map.distortion.flipped.empty());
    EXPECT_LT(map.distortion.max, 1);
    EXPECT_LT((map.positions.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
}

/// A sphere with bumps, smooth and without symmetry.
Mesh bumpy_sphere(int levels) {
    Mesh mesh = icosahedral_sphere(levels);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        const double radius = 1 + 0.25 * std::sin(3 * p.x() + 1) * p.y() + 0.3 * std::cos(4 * p.z() - p.x());
        mesh.positions.row(v) *= radius;
    }
    return mesh;
}

/// Where conformal maps send the points of a spheroid with half-axes 1, 1, c over the given points of the sphere.
Positions exact_spheroid(const Positions& sphere, double c) {
    // With latitude b from the pole, d log tan(θ/2) = √(cos²b + c² sin²b)/sin b db; 1/sin b is integrated apart.
    const auto rest = [c](double b) {
        const double s = std::sin(b), cosine = std::cos(b);
        return s < 1e-9 ? 0 : (std::sqrt(cosine * cosine + c * c * s * s) - 1) / s;
    };
    Positions image(sphere.rows(), 3);
    for (Eigen::Index v = 0; v < sphere.rows(); ++v) {
        const double b = std::acos(std::clamp(sphere(v, 2), -1.0, 1.0));
        constexpr int kPieces = 400;
        double integral = 0;  // Simpson's rule from the equator
        for (int i = 0; i < kPieces; ++i) {
            const double h = (b - kPi / 2) / kPieces, left = kPi / 2 + i * h;
            integral += h / 6 * (rest(left) + 4 * rest(left + h / 2) + rest(left + h));
        }
        const double theta = 2 * std::atan(std::tan(b / 2) * std::exp(integral)),
                     phi = std::atan2(sphere(v, 1), sphere(v, 0));
        image.row(v) << std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta);
    }
    return image;
}

TEST(SphereMap, APolyhedronInscribedInTheSphereIsItsOwnImage) {
    const Surface surface(icosahedral_sphere(3));
    const SphereMap map = sphere_map(surface);
    expect_one_to_one(surface, map);
    const Eigen::VectorXd areas = vertex_areas(surface.operators);
    const Eigen::VectorXd d =
        distances_up_to_rotation(map.positions, centred(surface.mesh.positions, areas).points, areas);
    EXPECT_LT(d.maxCoeff(), 1e-9);
    EXPECT_LT(map.distortion.max, 1e-9);
    EXPECT_EQ(map.route, SphereRoute::direct);
    EXPECT_LT(map.residual, 1e-10);
}

TEST(SphereMap, SpheroidConvergesWithOrderTwo) {
    // Measured with the prototype: largest and mean square error.
    const double table[][2] = {{3.0e-2, 2.2e-2}, {8.9e-3, 6.4e-3}, {2.3e-3, 1.7e-3}};
    double previous = 0;
    for (int level = 2; level <= 4; ++level) {
        Mesh mesh = octahedral_sphere(level);
        const Positions exact = exact_spheroid(mesh.positions, 3);
        mesh.positions.col(2) *= 3;
        const Surface surface(std::move(mesh));
        const SphereMap map = sphere_map(surface);
        expect_one_to_one(surface, map);
        const Eigen::VectorXd areas = vertex_areas(surface.operators);
        const Eigen::VectorXd d = distances_up_to_rotation(map.positions, centred(exact, areas).points, areas);
        const double rms = std::sqrt(areas.dot(d.cwiseAbs2()) / areas.sum());
        EXPECT_LT(d.maxCoeff(), 1.05 * table[level - 2][0]) << level;
        EXPECT_LT(rms, 1.05 * table[level - 2][1]) << level;
        if (previous > 0) {
            EXPECT_GT(std::log2(previous / rms), level == 3 ? 1.7 : 1.85) << level;
        }
        previous = rms;
    }
}

TEST(SphereMap, DoesNotDependOnTheIdealVertex) {
    const Surface surface(bumpy_sphere(3));
    const Eigen::VectorXd areas = vertex_areas(surface.operators);
    const SphereMap map = sphere_map(surface);
    expect_one_to_one(surface, map);
    for (const int ideal : {0, 17, 200, 333, 641}) {
        SphereMapOptions options;
        options.ideal_vertex = ideal;
        const SphereMap other = sphere_map(surface, options);
        EXPECT_EQ(*other.ideal_vertex, ideal);
        EXPECT_LT(distances_up_to_rotation(other.positions, map.positions, areas).maxCoeff(), 1e-9) << ideal;
    }
}

TEST(SphereMap, DoesNotDependOnSizePlaceOrNumbers) {
    const Mesh mesh = bumpy_sphere(2);
    const SphereMap map = sphere_map(Surface(mesh));
    const Eigen::VectorXd areas = vertex_areas(Surface(mesh).operators);
    Mesh moved = mesh;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    moved.positions = (1e4 * mesh.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(100, -20, 3);
    EXPECT_LT(distances_up_to_rotation(sphere_map(Surface(moved)).positions, map.positions, areas).maxCoeff(), 1e-9);

    std::vector<int> order(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(order.begin(), order.end(), 0);
    Random random(4);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
    Mesh renumbered = mesh;
    FaceList faces;
    for (int v = 0; v < mesh.vertex_count(); ++v) renumbered.positions.row(order[v]) = mesh.positions.row(v);
    for (int f = mesh.face_count() - 1; f >= 0; --f)
        faces.add({order[mesh.faces[f][1]], order[mesh.faces[f][2]], order[mesh.faces[f][0]]});
    renumbered.faces = faces;
    const SphereMap other = sphere_map(Surface(renumbered));
    Positions back(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) back.row(v) = other.positions.row(order[v]);
    EXPECT_LT(distances_up_to_rotation(back, map.positions, areas).maxCoeff(), 1e-9);
}

/// The largest height of a vertex above the plane of a triangle of the polyhedron found, and whether all lie below.
double above_the_hull(const Mesh& mesh, int ideal) {
    const Topology shape = topology(mesh);
    const TriangleMetric metric = triangle_metric(mesh, shape, corner_positions(mesh));
    IntrinsicTriangulation triangulation(metric.triangles, mesh.vertex_count(), metric.log_lengths);
    triangulation.make_delaunay();
    const std::vector<char> used(static_cast<std::size_t>(mesh.vertex_count()), 1);
    const IdealSphere sphere = ideal_sphere(triangulation, ideal, used, 1e-11, 200);
    EXPECT_TRUE(sphere.solved());
    Positions points = sphere_points(around_median(sphere.plane, Eigen::VectorXd::Ones(mesh.vertex_count())));
    points.row(ideal) << 0, 0, -1;
    points = centred(points, Eigen::VectorXd::Ones(mesh.vertex_count())).points;
    double most = 0;
    const IntrinsicTriangulation& hull = sphere.triangulation.triangulation();
    for (int t = 0; t < hull.triangle_count(); ++t) {
        const Eigen::Vector3d a = points.row(hull.tail(3 * t)), b = points.row(hull.tail(3 * t + 1)),
                              c = points.row(hull.tail(3 * t + 2));
        const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
        EXPECT_GT(oriented_volume(a, b, c), 0);
        for (int v = 0; v < mesh.vertex_count(); ++v) most = std::max(most, normal.dot(points.row(v).transpose() - a));
    }
    return most;
}

TEST(IdealSphere, IsTheConvexHullOfItsPoints) {
    const Mesh mesh = bumpy_sphere(2);
    for (const int ideal : {3, 50, 160}) EXPECT_LT(above_the_hull(mesh, ideal), 1e-9) << ideal;
    Mesh wild = icosahedral_sphere(2);  // radii that differ by a factor of 10
    Random random(11);
    for (int v = 0; v < wild.vertex_count(); ++v) wild.positions.row(v) *= std::exp(random.uniform(-0.7, 1.6));
    for (const int ideal : ideal_candidates(
             [&] {
                 const TriangleMetric metric = triangle_metric(wild, topology(wild), corner_positions(wild));
                 IntrinsicTriangulation t(metric.triangles, wild.vertex_count(), metric.log_lengths);
                 t.make_delaunay();
                 return t;
             }(),
             wild.positions)) {
        if (ideal % 40 != 0) continue;
        EXPECT_LT(above_the_hull(wild, ideal), 1e-7) << ideal;
    }
}

TEST(SphereMap, PolygonsOfAnyNumberOfCorners) {
    // The corners of a regular dodecahedron lie on a sphere: pentagons, its own image.
    const double g = std::numbers::phi;
    std::vector<Eigen::Vector3d> corners;
    for (const int x : {-1, 1})
        for (const int y : {-1, 1}) {
            for (const int z : {-1, 1}) corners.emplace_back(x, y, z);
            corners.emplace_back(0, x / g, y * g);
            corners.emplace_back(x / g, y * g, 0);
            corners.emplace_back(x * g, 0, y / g);
        }
    Mesh mesh;
    mesh.positions.resize(20, 3);
    for (int v = 0; v < 20; ++v) mesh.positions.row(v) = corners[v];
    std::vector<Eigen::Vector3d> normals;  // of the faces: corners of an icosahedron
    for (const int a : {-1, 1})
        for (const int b : {-1, 1}) {
            normals.emplace_back(0, a * g, b);
            normals.emplace_back(a, 0, b * g);
            normals.emplace_back(a * g, b, 0);
        }
    for (Eigen::Vector3d n : normals) {
        n.normalize();
        std::vector<int> face;
        double most = 0;
        for (const auto& c : corners) most = std::max(most, n.dot(c));
        for (int v = 0; v < 20; ++v)
            if (n.dot(corners[v]) > most - 1e-9) face.push_back(v);
        ASSERT_EQ(face.size(), 5U);
        const TangentFrame frame(n);
        std::sort(face.begin(), face.end(), [&](int a, int b) {
            return std::atan2(corners[a].dot(frame.second), corners[a].dot(frame.first)) <
                   std::atan2(corners[b].dot(frame.second), corners[b].dot(frame.first));
        });
        mesh.faces.add(face);
    }
    const SphereMap map = sphere_map(mesh);
    const Positions own = mesh.positions.rowwise().normalized();
    EXPECT_LT(distances_up_to_rotation(map.positions, own, Eigen::VectorXd::Ones(20)).maxCoeff(), 1e-9);
    EXPECT_LT(map.distortion.max, 1e-9);

    // A cube in quads, and a prism with hexagons.
    Mesh cube;
    cube.positions.resize(8, 3);
    for (int v = 0; v < 8; ++v) cube.positions.row(v) << v % 2, v / 2 % 2, v / 4;
    for (const auto& f : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        cube.faces.add({f[0], f[1], f[2], f[3]});
    const Surface quads(cube);
    const SphereMap of_cube = sphere_map(quads);
    expect_one_to_one(quads, of_cube);
    EXPECT_LT(of_cube.distortion.max, 1e-9);  // each quad is a square on the sphere too
    EXPECT_EQ(quads.operators.sample_count(), of_cube.distortion.mu.size());
    Mesh prism;
    prism.positions.resize(12, 3);
    for (int v = 0; v < 12; ++v)
        prism.positions.row(v) << std::cos(kPi / 3 * (v % 6)), std::sin(kPi / 3 * (v % 6)), v / 6 * 1.5;
    prism.faces.add({5, 4, 3, 2, 1, 0});
    prism.faces.add({6, 7, 8, 9, 10, 11});
    for (int i = 0; i < 6; ++i) prism.faces.add({i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
    const SphereMap of_prism = sphere_map(prism);
    expect_one_to_one(Surface(split_unusable_faces(prism).mesh), of_prism);
    for (int v = 0; v < 6; ++v)  // its symmetries are the map's
        EXPECT_NEAR((of_prism.positions.row(v) - of_prism.positions.row(v + 6)).norm(),
                    (of_prism.positions.row(0) - of_prism.positions.row(6)).norm(), 1e-9);
}

TEST(SphereMap, QuadsMayTurnInButNotFold) {
    // Cubes bent so far that no map is found that keeps every corner of every quad convex; no triangle is flipped.
    for (const std::uint64_t seed : {4, 24}) {
        Random random(seed);
        Mesh cube;
        cube.positions.resize(8, 3);
        for (int v = 0; v < 8; ++v) {
            cube.positions.row(v) << v % 2, v / 2 % 2, v / 4;
            for (int d = 0; d < 3; ++d) cube.positions(v, d) += random.uniform(-0.6, 0.6);
        }
        for (const auto& f :
             {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
            cube.faces.add({f[0], f[1], f[2], f[3]});
        const SphereMap map = sphere_map(cube);
        const Surface surface(split_unusable_faces(cube).mesh);
        const SphereFaces faces(surface);
        EXPECT_FALSE(faces.flipped(map.positions).empty());
        EXPECT_TRUE(faces.upright_as_triangles(map.positions));
        EXPECT_TRUE(map.distortion.flipped.empty());
        ASSERT_FALSE(map.warnings.empty());
        EXPECT_EQ(map.warnings[0].kind, WarningKind::turned_in);
        EXPECT_FALSE(map.warnings[0].where.indices.empty());
    }
}

TEST(SphereMap, OtherMethods) {
    const Surface surface(bumpy_sphere(3));
    const SphereMap equivalent = sphere_map(surface);
    SphereMapOptions options;
    options.method = SphereMethod::tutte;
    const SphereMap tutte = sphere_map(surface, options);
    expect_one_to_one(surface, tutte);
    EXPECT_GT(tutte.distortion.mean, 3 * equivalent.distortion.mean);
    options.method = SphereMethod::least_distortion;
    const SphereMap least = sphere_map(surface, options);
    expect_one_to_one(surface, least);
    EXPECT_LT(least.distortion.mean, 1.02 * equivalent.distortion.mean);
    EXPECT_LT(least.centre_distance, 1e-10);
    // Both are near the same conformal map.
    const Eigen::VectorXd areas = vertex_areas(surface.operators);
    const Eigen::VectorXd d = distances_up_to_rotation(least.positions, equivalent.positions, areas);
    EXPECT_LT(std::sqrt(areas.dot(d.cwiseAbs2()) / areas.sum()), 0.02);
}

TEST(SphereMap, ThinLimbsAreResolvedOrRefusedWithTheirShare) {
    // A rod of length L and radius r shrinks by exp(−L/r): 1e-9 is mapped, 1e-26 is not to be resolved.
    const Surface resolved(test::ball_with_rod(2, 0.1));
    const SphereMap map = sphere_map(resolved);
    expect_one_to_one(resolved, map);
    EXPECT_TRUE(map.unresolved.empty());
    try {
        const SphereMap lost = sphere_map(Surface(test::ball_with_rod(6, 0.1)));
        FAIL() << "flips " << lost.distortion.flipped.size() << ", " << to_string(lost.route);
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        EXPECT_NE(std::string(error.what()).find("% of the area"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("1e-13"), std::string::npos) << error.what();
        EXPECT_FALSE(error.indices().empty());
    }
}

TEST(SphereMap, RefusesOtherSurfaces) {
    const auto refused = [](Mesh mesh, const std::string& because) {
        try {
            sphere_map(Surface(std::move(mesh)));
            FAIL() << because;
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_mesh);
            EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
        }
    };
    Mesh open = icosahedral_sphere(1), two = open;
    FaceList fewer;
    for (int f = 1; f < open.face_count(); ++f) fewer.add(open.faces[f]);
    open.faces = fewer;
    refused(open, "open, with 1 boundary loops");
    const int n = two.vertex_count();
    two.positions.conservativeResize(2 * n, 3);
    two.positions.bottomRows(n) = two.positions.topRows(n).rowwise() + Eigen::RowVector3d(5, 0, 0);
    for (int f = 0, count = two.face_count(); f < count; ++f)
        two.faces.add({two.faces[f][0] + n, two.faces[f][1] + n, two.faces[f][2] + n});
    refused(two, "2 components");
    Mesh torus;
    torus.positions.resize(96, 3);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 8; ++j) {
            const double a = 2 * kPi * i / 12, b = 2 * kPi * j / 8, r = 2 + std::cos(b);
            torus.positions.row(8 * i + j) << r * std::cos(a), r * std::sin(a), std::sin(b);
            const auto at = [&](int x, int y) { return 8 * (x % 12) + y % 8; };
            torus.faces.add({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    refused(torus, "genus 1");

    SphereMapOptions options;
    options.ideal_vertex = 1000;
    const Surface sphere(icosahedral_sphere(1));
    EXPECT_THROW(sphere_map(sphere, options), Error);
    options.ideal_vertex = {};
    options.tolerance = 0;
    EXPECT_THROW(sphere_map(sphere, options), Error);
}

/// Statistics of |μ| that a real mesh had with the prototype.
struct Known {
    const char* name;
    double mean, deviation, largest;
};

class RealSphereMap : public testing::TestWithParam<Known> {};

TEST_P(RealSphereMap, IsNoWorseThanKnown) {
    const auto path = test::real_mesh(GetParam().name);
    if (path.empty()) GTEST_SKIP() << "no real meshes";
    Mesh mesh = split_unusable_faces(remove_unreferenced(read_mesh(path).mesh).mesh).mesh;
    const Surface surface(mesh);
    const SphereMap map = sphere_map(surface);
    expect_one_to_one(surface, map);
    EXPECT_EQ(map.method, SphereMethod::conformal_equivalence);
    EXPECT_LT(map.distortion.mean, GetParam().mean);
    EXPECT_LT(map.distortion.standard_deviation, GetParam().deviation);
    EXPECT_LT(map.distortion.max, GetParam().largest);
    EXPECT_LT(map.centre_distance, 1e-10);
    if (surface.operators.sample_count() == mesh.face_count()) {
        EXPECT_NEAR(covering_degree(mesh.faces, map.positions), 1, 1e-9);
    }
}

// Of fish_quad and spot_control_mesh the table's values are of triangles; here quads are measured as such.
INSTANTIATE_TEST_SUITE_P(Scans, RealSphereMap,
                         testing::Values(Known{"cow.off", .1105, .1325, .9956},
                                         Known{"hippocampus.obj", .02845, .0155, .2025},
                                         Known{"hand_closed.obj", .04585, .0385, .1765},
                                         Known{"fish_quad.obj", .0438, .047, .7},
                                         Known{"spot_control_mesh.obj", .34, .26, .996}),
                         [](const auto& test) {
                             std::string name = test.param.name;
                             return name.substr(0, name.find('.'));
                         });

TEST(RealSphereMaps, DoNotDependOnTheIdealVertex) {
    const auto path = test::real_mesh("cow.off");
    if (path.empty()) GTEST_SKIP() << "no real meshes";
    const Mesh mesh = remove_unreferenced(read_mesh(path).mesh).mesh;
    const TriangleMetric metric = triangle_metric(mesh, topology(mesh), corner_positions(mesh));
    IntrinsicTriangulation triangulation(metric.triangles, mesh.vertex_count(), metric.log_lengths);
    triangulation.make_delaunay();
    const std::vector<int> candidates = ideal_candidates(triangulation, mesh.positions);
    const Eigen::VectorXd areas = vertex_areas(Surface(mesh).operators);
    const std::vector<char> used(static_cast<std::size_t>(mesh.vertex_count()), 1);
    const auto points_with = [&](int ideal) {
        const IdealSphere sphere = ideal_sphere(triangulation, ideal, used, 1e-10, 200);
        EXPECT_TRUE(sphere.solved());
        Eigen::VectorXd weights = areas;
        weights[ideal] = 0;
        Positions points = sphere_points(around_median(sphere.plane, weights));
        points.row(ideal) << 0, 0, -1;
        return centred(points, areas).points;
    };
    const Positions best = points_with(candidates[0]);
    for (const std::size_t other : {candidates.size() / 4, candidates.size() / 2, 3 * candidates.size() / 4})
        EXPECT_LT(distances_up_to_rotation(points_with(candidates[other]), best, areas).maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace beltrami
