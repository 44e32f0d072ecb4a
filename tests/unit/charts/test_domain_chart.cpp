#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/charts/hole_centre.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/circle_fit.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

std::vector<Circle> circles(int n) {
    std::vector<Circle> holes;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.399963 * i, r = 0.8 * std::sqrt((i + 0.5) / n);
        holes.push_back({{r * std::cos(angle), r * std::sin(angle)}, 0.28 / std::sqrt(n)});
    }
    return holes;
}

Mesh domain(int holes, double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return circle_domain({}, circles(holes), options);
}

Mesh lifted(Mesh mesh) {
    Positions points(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        points.row(v) << x, y, 0.5 * std::sin(2.5 * x + 0.3) * std::cos(2 * y);
    }
    mesh.positions = points;
    return mesh;
}

std::vector<Complex> rim(const Surface& source, const Chart& chart, int loop) {
    std::vector<Complex> points;
    for (const int v : source.topology.boundary_loops[loop]) points.push_back(chart.vertices[v]);
    return points;
}

/// What every chart promises.
void check_chart(const Surface& source, const Chart& chart, int outer_loop) {
    EXPECT_EQ(chart.outer_loop, outer_loop);
    for (const int v : source.topology.boundary_loops[outer_loop]) EXPECT_NEAR(std::abs(chart.vertices[v]), 1, 2e-7);
    ASSERT_EQ(chart.holes.size() + 1, source.topology.boundary_loops.size());
    int loop = 0;
    for (const Chart::Hole& hole : chart.holes) {
        if (loop == outer_loop) ++loop;
        EXPECT_EQ(hole.loop, loop++);
        EXPECT_LT(std::abs(hole.centre), 1);
        for (const Complex z : rim(source, chart, hole.loop)) {
            EXPECT_LT(std::abs(z), 1);
            EXPECT_GE(std::abs(z - hole.centre), 0.5 * hole.radius * (1 - 1e-9));
        }
    }
}

double mean_mu(const Surface& source, const Chart& chart) {
    return distortion(source.operators, chart.vertices).mean;
}

/// How far the chart is from a holomorphic function of z: root mean square residual of the best sum of powers of z and
/// of 1/(z − c) at the vertices.
double holomorphy_defect(const Chart& chart, const Eigen::VectorXcd& z, const std::vector<Circle>& holes) {
    const int powers = 16, terms = 8, n = static_cast<int>(z.size());
    Eigen::MatrixXcd A(n, powers + terms * static_cast<int>(holes.size()));
    for (int v = 0; v < n; ++v) {
        int column = 0;
        for (int j = 0; j < powers; ++j) A(v, column++) = std::pow(z[v], j);
        for (const Circle& hole : holes)
            for (int j = 1; j <= terms; ++j)
                A(v, column++) = std::pow(hole.radius / (z[v] - Complex(hole.centre.x(), hole.centre.y())), j);
    }
    const Eigen::MatrixXcd Q = complex_qr(A).Q;
    return (Q * (Q.adjoint() * chart.vertices) - chart.vertices).norm() / std::sqrt(n);
}

TEST(DomainChart, OfADiskIsTheRoundDiskChart) {
    for (const Mesh& mesh : {disk(8), test::bump(600)}) {
        const Surface source(mesh);
        const Chart chart = domain_chart(source), disk_chart = round_disk_chart(source);
        EXPECT_EQ(chart.vertices, disk_chart.vertices);
        EXPECT_EQ(chart.derivatives, disk_chart.derivatives);
        EXPECT_EQ(chart.exact, disk_chart.exact);
        EXPECT_TRUE(chart.holes.empty());
    }
}

TEST(DomainChart, ARoundPlanarDomainIsItsOwnChart) {
    for (const int n : {1, 2, 5, 11, 27}) {
        Mesh mesh = domain(n, 0.1);
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        mesh.positions = (3e5 * mesh.positions).rowwise() + Eigen::RowVector2d(7e5, -2e5);
        const Surface source(mesh);
        const Chart chart = domain_chart(source);
        check_chart(source, chart, 0);
        EXPECT_TRUE(chart.exact);
        EXPECT_EQ(chart.excluded_faces, 0);
        EXPECT_LT((chart.vertices - z).cwiseAbs().maxCoeff(), 1e-9);
        for (const Chart::Hole& hole : chart.holes) {
            double nearest = 1;
            for (const Circle& circle : circles(n))
                nearest = std::min(nearest, std::abs(hole.centre - Complex(circle.centre.x(), circle.centre.y())));
            EXPECT_LT(nearest, 1e-9);
            EXPECT_NEAR(hole.radius, circles(n)[0].radius, 1e-9);
        }
    }
}

TEST(DomainChart, ARoundHoleGoesOutsideByAMoebiusMap) {
    Mesh mesh = domain(5, 0.1);
    for (const double side : {1.0, -1.0}) {  // seen from below, the plane is mirrored
        mesh.positions.col(1) *= side;
        const Surface source(mesh);
        for (int outer = 1; outer < 6; ++outer) {
            const Chart chart = domain_chart(source, outer);
            check_chart(source, chart, outer);
            EXPECT_TRUE(chart.exact);
            const Eigen::VectorXcd z = planar_coordinates(mesh), g = chart.vertices;
            const auto cross_ratio = [](const Eigen::VectorXcd& p, int d) {
                return (p[0] - p[20]) * (p[40] - p[d]) / ((p[0] - p[d]) * (p[40] - p[20]));
            };
            for (int v = 50; v < g.size(); v += 7)
                EXPECT_LT(std::abs(cross_ratio(z, v) - cross_ratio(g, v)), 1e-9 * (1 + std::abs(cross_ratio(z, v))));
            for (const Chart::Hole& hole : chart.holes) EXPECT_TRUE(fit_circle(rim(source, chart, hole.loop)).exact());
            // Positions and derivatives are the map's own at the samples' places.
            const Eigen::VectorXcd places = at_samples(source.operators, z);
            for (int s = 0; s < places.size(); s += 11) {
                const Complex h = 1e-6;
                const Complex difference =
                    (chart.analytic(places[s] + h)[0] - chart.analytic(places[s] - h)[0]) / (2.0 * h);
                EXPECT_LT(std::abs(chart.derivatives[s] - difference), 1e-6 * std::abs(difference));
                EXPECT_EQ(chart.positions[s], chart.analytic(places[s])[0]);
            }
            Complex mean = 0;
            for (int s = 0; s < places.size(); ++s)
                for (const int v : source.operators.stencil(s)) mean += source.operators.weights[s] / 3 * g[v];
            EXPECT_LT(std::abs(mean) / source.operators.area(), 1e-12);
        }
    }
}

Mesh wavy_domain(double edge_length, double aspect) {
    Polygon outer;
    for (int i = 0; i < 96; ++i) {
        const double t = i * std::numbers::pi / 48;
        outer.push_back({1.5 * std::cos(t), std::sin(t) * (1 + 0.2 * std::cos(2 * t))});
    }
    const auto slot = [&](Complex centre, double a, double turn) {
        Polygon polygon;
        for (const Complex corner :
             {Complex(-a, -a / aspect), Complex(a, -a / aspect), Complex(a, a / aspect), Complex(-a, a / aspect)}) {
            const Complex p = centre + std::polar(1.0, turn) * corner;
            polygon.push_back({p.real(), p.imag()});
        }
        return polygon;
    };
    DomainOptions options;
    options.edge_length = edge_length;
    options.hole_edge_length = 0.4 * edge_length;
    return polygon_domain(outer, {slot({-0.6, 0}, 0.25, 0.5), slot({0.5, 0.2}, 0.3, 1.2), slot({0, -0.5}, 0.2, 0)},
                          options);
}

TEST(DomainChart, PlanarDomainsKeepTheirCoordinates) {
    DomainChartOptions plain;
    plain.round_from = 100;
    double last = 0;
    for (const double h : {0.1, 0.05}) {
        const Surface source(wavy_domain(h, 2));
        const Chart chart = domain_chart(source, 0, nullptr, plain);
        check_chart(source, chart, 0);
        EXPECT_FALSE(chart.exact);
        EXPECT_EQ(chart.excluded_faces, 0);
        const double mu = mean_mu(source, chart);
        if (last > 0) {
            EXPECT_GT(std::log2(last / mu), 0.8);
        }  // of a piecewise linear map: first order
        last = mu;
    }
    EXPECT_LT(last, 0.02);
}

TEST(DomainChart, SlotsAreMadeRounder) {
    for (const double aspect : {1.0, 2.0, 5.0}) {
        const Surface source(wavy_domain(0.07, aspect));
        DomainChartOptions plain;
        plain.round_from = 100;
        const Chart before = domain_chart(source, 0, nullptr, plain), chart = domain_chart(source);
        check_chart(source, chart, 0);
        EXPECT_EQ(chart.excluded_faces, 0);
        double ratio_before = 1, ratio = 1;
        for (int l = 1; l < 4; ++l) {
            ratio_before = std::max(ratio_before, hole_centre(rim(source, before, l)).ratio);
            ratio = std::max(ratio, hole_centre(rim(source, chart, l)).ratio);
        }
        EXPECT_GT(ratio_before, 1.3);
        EXPECT_LT(ratio, 1.25);
        // The derivative is the analytic map's; that of the drawn faces agrees up to their size.
        double error = 0, total = 0;
        for (int s = 0; s < source.operators.sample_count(); ++s) {
            const Complex drawn = source.operators.derivatives(s, chart.vertices)[0];
            error += source.operators.weights[s] * std::abs(drawn / chart.derivatives[s] - 1.0);
            total += source.operators.weights[s];
        }
        EXPECT_LT(error / total, 0.03);
    }
}

TEST(DomainChart, SlotsAreMadeRounderAroundAnotherOne) {
    const Surface source(wavy_domain(0.07, 3));
    const Chart chart = domain_chart(source, 1);
    check_chart(source, chart, 1);
    EXPECT_EQ(chart.excluded_faces, 0);
    for (const int l : {0, 2, 3}) EXPECT_LT(hole_centre(rim(source, chart, l)).ratio, 1.35);
}

TEST(DomainChart, ARoundSourceStaysExactWhenItsHolesAreMadeRound) {
    // The unit disk with a slot, its boundary on the circle.
    Polygon outer;
    for (int i = 0; i < 120; ++i)
        outer.push_back({std::cos(i * std::numbers::pi / 60), std::sin(i * std::numbers::pi / 60)});
    DomainOptions options;
    options.edge_length = 0.08;
    options.hole_edge_length = 0.03;
    const Surface source(polygon_domain(outer, {{{-0.1, 0}, {0.5, 0.1}, {0.5, 0.35}, {-0.1, 0.25}}}, options));
    const Chart chart = domain_chart(source);
    check_chart(source, chart, 0);
    EXPECT_TRUE(chart.exact);
    EXPECT_LT(hole_centre(rim(source, chart, 1)).ratio, 1.25);
    const Eigen::VectorXcd z = planar_coordinates(source.mesh), places = at_samples(source.operators, z);
    for (int v = 0; v < z.size(); v += 13) EXPECT_EQ(chart.vertices[v], chart.analytic(z[v])[0]);
    for (int s = 0; s < places.size(); s += 11)
        for (const Complex h : {Complex(1e-6, 0), Complex(0, 1e-6)}) {
            const Complex slope = (chart.analytic(places[s] + h)[0] - chart.analytic(places[s] - h)[0]) / (2.0 * h);
            EXPECT_LT(std::abs(slope - chart.derivatives[s]), 1e-6 * std::abs(slope));
        }
}

TEST(DomainChart, HolesOfACurvedSurfaceConvergeWithSecondOrder) {
    // On a sphere every chart is holomorphic in the stereographic coordinate.
    const std::vector<Circle> holes = circles(3);
    for (const int least_rim : {6, 1000}) {  // by way of the annulus, and of the filled disk
        DomainChartOptions options;
        options.least_rim = least_rim;
        double last = 0;
        for (const double h : {0.12, 0.06}) {
            DomainOptions mesh_options;
            mesh_options.edge_length = h;
            mesh_options.least_hole_edges = static_cast<int>(1.8 / h);
            const Mesh flat = circle_domain({}, holes, mesh_options);
            const Surface source(test::on_sphere(flat));
            const Chart chart = domain_chart(source, 0, nullptr, options);
            check_chart(source, chart, 0);
            EXPECT_EQ(chart.excluded_faces, 0);
            const double defect = holomorphy_defect(chart, test::complex_positions(flat), holes);
            if (last > 0) {
                EXPECT_GT(std::log2(last / defect), 1.4) << least_rim;
            }
            last = defect;
        }
        EXPECT_LT(last, 2e-3) << least_rim;
    }
}

TEST(DomainChart, MeanMuOfALiftedDomainIsOfFirstOrder) {
    double last = 0;
    for (const double h : {0.1, 0.05}) {
        const Surface source(lifted(domain(5, h)));
        const Chart chart = domain_chart(source);
        check_chart(source, chart, 0);
        EXPECT_EQ(chart.excluded_faces, 0);
        const double mu = mean_mu(source, chart);
        if (last > 0) {
            EXPECT_GT(std::log2(last / mu), 0.7);
        }
        last = mu;
    }
    EXPECT_LT(last, 0.015);
}

TEST(DomainChart, DoesNotDependOnPlaceAndSize) {
    const Mesh mesh = lifted(domain(5, 0.12));
    for (const int outer : {0, 3})
        for (const int least_rim : {6, 1000}) {
            DomainChartOptions options;
            options.least_rim = least_rim;
            const Chart chart = domain_chart(Surface(mesh), outer, nullptr, options);
            for (const double scale : {1e-6, 1e6}) {
                Mesh moved = mesh;
                const Eigen::Matrix3d turn =
                    scale * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
                moved.positions = (mesh.positions * turn.transpose()).rowwise() + scale * Eigen::RowVector3d(3, -1, 2);
                const Chart other = domain_chart(Surface(moved), outer, nullptr, options);
                Complex phase = (chart.vertices.conjugate().cwiseProduct(other.vertices)).sum();
                phase /= std::abs(phase);
                EXPECT_LT((other.vertices - phase * chart.vertices).cwiseAbs().maxCoeff(), 1e-6) << outer << least_rim;
            }
        }
}

TEST(DomainChart, AMetricOfItsOwnGivesTheSameChart) {
    const Mesh flat = domain(3, 0.12), surface = lifted(flat);
    const Chart chart = domain_chart(Surface(surface), 2),
                other = domain_chart(Surface(flat, corner_positions(surface)), 2);
    Complex phase = (chart.vertices.conjugate().cwiseProduct(other.vertices)).sum();
    phase /= std::abs(phase);
    EXPECT_LT((other.vertices - phase * chart.vertices).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(DomainChart, ASphereWithTwelveHolesAnyOfThemOutside) {
    const Mesh sphere = icosahedral_sphere(4);
    std::vector<int> kept;
    for (int f = 0; f < sphere.face_count(); ++f) {
        const auto v = sphere.faces[f];
        const Eigen::Vector3d middle = (sphere.point(v[0]) + sphere.point(v[1]) + sphere.point(v[2])) / 3;
        double nearest = 2;
        for (int corner = 0; corner < 12; ++corner) nearest = std::min(nearest, (middle - sphere.point(corner)).norm());
        if (nearest > 0.3) kept.push_back(f);
    }
    const Surface source(keep_faces(sphere, kept).mesh);
    ASSERT_EQ(source.topology.boundary_loops.size(), 12u);
    for (const int outer : {0, 5, 11}) {
        const Chart chart = domain_chart(source, outer);
        check_chart(source, chart, outer);
        EXPECT_EQ(chart.excluded_faces, 0);
        EXPECT_LT(mean_mu(source, chart), 0.05);
        for (const Chart::Hole& hole : chart.holes) EXPECT_LT(hole_centre(rim(source, chart, hole.loop)).ratio, 1.2);
    }
}

TEST(DomainChart, TinyHoles) {
    std::vector<int> kept;
    const Mesh whole = test::bump(2400);
    for (int f = 0; f < whole.face_count(); ++f)
        if (f != 100 && f != 700 && f != 701) kept.push_back(f);
    const Surface source(keep_faces(whole, kept).mesh);
    for (int outer = 0; outer < static_cast<int>(source.topology.boundary_loops.size()); ++outer) {
        const Chart chart = domain_chart(source, outer);
        check_chart(source, chart, outer);
        if (outer == 0) {
            EXPECT_LT(mean_mu(source, chart), 0.03);
            EXPECT_EQ(chart.excluded_faces, 0);
        }
    }
}

TEST(AnnulusMap, IsExactUpToSecondOrder) {
    // A planar annulus with an excentric hole, on the sphere: its modulus is that of a round annulus by a Möbius map.
    const double r = 0.4, a = 0.3;  // |z| < r under w = (z + a)/(1 + a z)
    double last = 0;
    for (const int around : {30, 60}) {
        Mesh mesh = annulus(r, 1, around);
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Complex z(mesh.positions(v, 0), mesh.positions(v, 1)), w = (z + a) / (1.0 + a * z);
            mesh.positions.row(v) << w.real(), w.imag();
        }
        const Surface source(test::on_sphere(mesh));
        const int outer = std::abs(Complex(mesh.positions(source.topology.boundary_loops[0][0], 0),
                                           mesh.positions(source.topology.boundary_loops[0][0], 1))) > 0.99
                              ? 0
                              : 1;
        const Eigen::VectorXcd g = annulus_map(source, outer);
        for (const int v : source.topology.boundary_loops[outer]) EXPECT_NEAR(std::abs(g[v]), 1, 1e-14);
        const auto& inner = source.topology.boundary_loops[1 - outer];
        for (const int v : inner) EXPECT_NEAR(std::abs(g[v]), std::abs(g[inner[0]]), 1e-14);
        EXPECT_TRUE(distortion(source.operators, g).flipped.empty());
        const double error = std::abs(std::abs(g[inner[0]]) - r);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.7);
        }
        last = error;
    }
    EXPECT_LT(last, 1e-3);
}

TEST(AnnulusMap, OfQuads) {
    std::vector<int> kept;
    const Mesh whole = test::quad_disk(10);
    for (int f = 0; f < whole.face_count(); ++f) {
        double r = 0;
        for (const int v : whole.faces[f]) r = std::max(r, whole.positions.row(v).norm());
        if (r > 0.35) kept.push_back(f);
    }
    const Surface source(keep_faces(whole, kept).mesh);
    ASSERT_EQ(source.topology.boundary_loops.size(), 2u);
    const Eigen::VectorXcd g = annulus_map(source, 0);
    const Distortion d = distortion(source.operators, g);
    EXPECT_LT(d.mean, 0.06);
    EXPECT_LT(d.flipped.size(), 5u);
}

TEST(DomainChart, RealMeshes) {
    const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
    if (!folder || !std::filesystem::exists(folder)) GTEST_SKIP() << "BELTRAMI_TEST_MESHES names no folder of meshes";
    struct Case {
        const char* name;
        double mu;
        bool exact;
    };
    for (const auto& [name, mu, exact] :
         {Case{"alex_3.obj", 0.03, false}, {"amoeba1.obj", 0.04, false}, {"mcqc3d_planar_src.obj", 0.05, true}}) {
        const auto path = std::filesystem::path(folder) / name;
        if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << name;
        const Surface source(read_mesh(path.string()).mesh);
        for (const int outer : {0, 1}) {
            const Chart chart = domain_chart(source, outer);
            check_chart(source, chart, outer);
            EXPECT_EQ(chart.exact, exact);
            EXPECT_TRUE(distortion(source.operators, chart.vertices).flipped.empty());
            EXPECT_LT(chart.excluded_faces, 0.002 * source.mesh.face_count());  // |μ| ≥ ½
            EXPECT_LT(mean_mu(source, chart), mu);
            for (const Chart::Hole& hole : chart.holes)
                EXPECT_LT(hole_centre(rim(source, chart, hole.loop)).ratio, 1.2);
        }
    }
}

TEST(DomainChart, RefusesOtherSurfaces) {
    EXPECT_THROW(domain_chart(Surface(annulus(0.3, 1, 20)), 2), Error);
    EXPECT_THROW(domain_chart(Surface(annulus(0.3, 1, 20)), -1), Error);
    EXPECT_THROW(domain_chart(Surface(icosahedral_sphere(1))), Error);
}

}  // namespace
}  // namespace beltrami
