#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/plane/segment_tree.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

struct Refusal {
    bool refused = false;
    Cause cause{};
    std::string what;
    std::vector<int> indices;
    bool says(const std::string& words) const { return what.find(words) != std::string::npos; }
    bool names(int v) const { return std::find(indices.begin(), indices.end(), v) != indices.end(); }
};

Refusal examine(const Surface& surface, const BoundaryCondition& boundary, int outer = 0) {
    try {
        require_feasible(surface, boundary, outer);
    } catch (const Error& error) {
        return {true, error.cause(), error.what(), error.indices()};
    }
    return {};
}

/// A square plate with two square holes, and its own positions as boundary values.
struct Plate {
    Surface surface{make()};
    BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
    static Mesh make() {
        Mesh mesh = test::jittered_square(12);
        FaceList faces;
        for (int f = 0; f < mesh.face_count(); ++f) {
            const int cell = f / 2, i = cell % 12, j = cell / 12;
            const bool first = i >= 2 && i < 4 && j >= 2 && j < 4, second = i >= 7 && i < 9 && j >= 6 && j < 9;
            if (!first && !second) faces.add(mesh.faces[f]);
        }
        mesh.faces = faces;
        return remove_unreferenced(mesh).mesh;
    }
    static constexpr Complex first_centre{3 / 12., 3 / 12.}, second_centre{8 / 12., 7.5 / 12.};
    int hole_at(Complex centre) const {
        for (int l = 1; l < 3; ++l) {
            Complex mean = 0;
            for (const int v : surface.topology.boundary_loops[l]) mean += at(v);
            if (std::abs(mean / double(surface.topology.boundary_loops[l].size()) - centre) < 0.1) return l;
        }
        return -1;
    }
    Complex at(int v) const { return {surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)}; }
    BoundaryCondition with_loop(int loop, const std::function<Complex(Complex)>& f) const {
        BoundaryCondition result = boundary;
        const auto& vertices = surface.topology.boundary_loops[loop];
        for (std::size_t i = 0; i < result.vertices.size(); ++i)
            if (std::find(vertices.begin(), vertices.end(), result.vertices[i]) != vertices.end())
                result.images[i] = f(result.images[i]);
        return result;
    }
    int inner_vertex(int skip = 0) const {
        for (int v = 0;; ++v)
            if (!surface.topology.on_boundary[v] && skip-- == 0) return v;
    }
};

TEST(Feasibility, AcceptsTheIdentityAndMapsOfIt) {
    const Plate plate;
    EXPECT_FALSE(examine(plate.surface, plate.boundary).refused);
    for (const double turn : {0.0, 0.1, 0.7, 2.0})
        EXPECT_FALSE(
            examine(plate.surface,
                    test::boundary_values(plate.surface,
                                          [&](Complex z) { return std::polar(1e3, turn) * z + Complex(5e4, -3e5); }))
                .refused);
    EXPECT_FALSE(examine(Surface(annulus(0.4, 1, 30)),
                         test::boundary_values(Surface(annulus(0.4, 1, 30)), [](Complex z) { return z * std::abs(z); }))
                     .refused);
}

TEST(Feasibility, AnyLoopMayBeTheOuterOne) {
    // Inversion exchanges the two loops of an annulus and, composed with a reflection, keeps the orientation.
    const Surface surface(annulus(0.4, 1, 30));
    const BoundaryCondition inverted = test::boundary_values(surface, [](Complex z) { return 1.0 / z; });
    const Refusal refusal = examine(surface, inverted, 0);
    EXPECT_TRUE(refusal.refused);
    EXPECT_TRUE(refusal.says("clockwise"));
    EXPECT_FALSE(examine(surface, inverted, 1).refused);
    EXPECT_EQ(examine(surface, inverted, 2).cause, Cause::bad_option);
}

TEST(Feasibility, LoopsThatAreNotSimple) {
    const Surface surface(disk(8));
    const auto values = [&](const std::function<Complex(Complex)>& f) {
        return examine(surface, test::boundary_values(surface, f));
    };
    const Refusal point = values([](Complex) { return Complex(1, 1); });
    EXPECT_TRUE(point.says("coincide"));
    EXPECT_EQ(point.indices.size(), 2u);
    EXPECT_TRUE(values([](Complex z) { return std::conj(z); }).says("clockwise"));
    const Refusal there_and_back = values([](Complex z) { return Complex(z.real(), 0.3 * z.real()); });
    EXPECT_TRUE(there_and_back.says("straight back at vertex"));
    EXPECT_EQ(there_and_back.indices.size(), 3u);
    const Refusal backwards =
        values([](Complex z) { return std::polar(1.0, std::arg(z) + 1.4 * std::sin(std::arg(z))); });
    EXPECT_TRUE(backwards.says("run backwards or cross themselves"));
    EXPECT_EQ(backwards.indices.size(), 4u);
    EXPECT_TRUE(values([](Complex z) { return z + 0.9 * z * z * z; }).refused);
    EXPECT_TRUE(values([](Complex z) { return z * (0.5 + z.real()); }).refused);
    EXPECT_TRUE(values([](Complex z) { return Complex(std::sin(std::arg(z)), std::sin(2 * std::arg(z))); }).refused);
    EXPECT_FALSE(values([](Complex z) { return z + 0.2 * z * z; }).refused);
    // Two vertices far apart on one point.
    BoundaryCondition twice = test::boundary_values(surface, [](Complex z) { return z; });
    twice.images[20] = twice.images[5];
    const Refusal pair = examine(surface, twice);
    EXPECT_TRUE(pair.says("same image"));
    EXPECT_TRUE(pair.names(twice.vertices[20]) && pair.names(twice.vertices[5]));
}

TEST(Feasibility, AgreesWithComparingAllPairs) {
    const Surface surface(disk(6));
    const auto& loop = surface.topology.boundary_loops[0];
    const std::size_t n = loop.size();
    std::mt19937 random(11);
    const auto uniform = [&] { return static_cast<double>(random()) / static_cast<double>(random.max()); };
    int refused = 0;
    constexpr int kTrials = 300;
    for (int trial = 0; trial < kTrials; ++trial) {
        const double amount = 0.4 * uniform();
        BoundaryCondition boundary;
        for (std::size_t i = 0; i < n; ++i)
            boundary.pin(loop[i], std::polar(1.0, 2 * kPi * static_cast<double>(i) / static_cast<double>(n)) +
                                      amount * Complex(uniform() - 0.5, uniform() - 0.5));
        const auto edge = [&](std::size_t i) { return Segment{boundary.images[i], boundary.images[(i + 1) % n]}; };
        bool meets = false;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 2; j < n; ++j)
                meets = meets || ((i > 0 || j + 1 < n) && segments_meet(edge(i), edge(j)));
        EXPECT_EQ(examine(surface, boundary).refused, meets);
        refused += meets;
    }
    EXPECT_GT(refused, kTrials / 10);
    EXPECT_LT(refused, kTrials - kTrials / 10);
}

TEST(Feasibility, Holes) {
    const Plate plate;
    const int first = plate.hole_at(Plate::first_centre), second = plate.hole_at(Plate::second_centre);
    ASSERT_TRUE(first > 0 && second > 0 && first != second);
    const auto moved = [&](int loop, const std::function<Complex(Complex)>& f) {
        return examine(plate.surface, plate.with_loop(loop, f));
    };
    EXPECT_TRUE(moved(first, [](Complex z) { return z + 3.0; }).says("outside the image of boundary loop 0"));
    const Refusal crossing = moved(first, [](Complex z) { return z - 0.25; });
    EXPECT_TRUE(crossing.says("meet"));
    EXPECT_EQ(crossing.indices.size(), 4u);
    EXPECT_TRUE(moved(first, [](Complex z) { return z + Plate::second_centre - Plate::first_centre; }).refused);
    const Refusal nested =
        moved(first, [](Complex z) { return 0.3 * (z - Plate::first_centre) + Plate::second_centre; });
    EXPECT_TRUE(nested.says("inside the image of boundary loop " + std::to_string(second)));
    const Refusal mirrored =
        moved(second, [](Complex z) { return std::conj(z - Plate::second_centre) + Plate::second_centre; });
    EXPECT_TRUE(mirrored.says("counter-clockwise"));
    EXPECT_EQ(mirrored.indices, plate.surface.topology.boundary_loops[second]);
}

TEST(Feasibility, Pins) {
    const Plate plate;
    const int v = plate.inner_vertex(), w = plate.inner_vertex(1);
    const auto pinned = [&](Complex image) {
        BoundaryCondition boundary = plate.boundary;
        boundary.pin(v, image);
        return examine(plate.surface, boundary);
    };
    EXPECT_FALSE(pinned({0.05, 0.06}).refused);
    EXPECT_TRUE(pinned({1.5, 0.5}).says("outside"));
    EXPECT_TRUE(pinned({0.5, -0.01}).says("outside"));
    EXPECT_TRUE(pinned(Plate::first_centre).says("a hole"));
    EXPECT_TRUE(pinned({0.54, 0}).says("lies on the image of the boundary edge"));
    const Refusal on_vertex = pinned(plate.boundary.images[3]);
    EXPECT_TRUE(on_vertex.says("same image"));
    EXPECT_TRUE(on_vertex.names(v) && on_vertex.names(plate.boundary.vertices[3]));
    BoundaryCondition both = plate.boundary;
    both.pin(w, {0.5, 0.5});
    both.pin(v, {0.5, 0.5});
    EXPECT_EQ(examine(plate.surface, both).indices, (std::vector{v, w}));
}

TEST(Feasibility, LinesThatMissTheTarget) {
    const Plate plate;
    const int v = plate.inner_vertex();
    const auto on_line = [&](Complex point, Complex direction) {
        BoundaryCondition boundary = plate.boundary;
        boundary.pin_to_line(v, point, direction);
        return examine(plate.surface, boundary);
    };
    EXPECT_FALSE(on_line({0.05, 7}, {0, 3}).refused);
    EXPECT_FALSE(on_line(Plate::first_centre, {1, 1}).refused) << "through a hole, but not only";
    EXPECT_FALSE(on_line({-3, -3.9}, {1, 1}).refused);
    for (const auto& [point, direction] :
         {std::pair(Complex(5, 0.5), Complex(0, 1)), std::pair(Complex(1, 0), Complex(0, 1)),
          std::pair(Complex(0.5, 2.1), Complex(1, 1))}) {
        const Refusal missed = on_line(point, direction);
        EXPECT_TRUE(missed.says("misses"));
        EXPECT_TRUE(missed.names(v));
        EXPECT_EQ(missed.cause, Cause::bad_boundary);
    }
}

TEST(Feasibility, FreePartsAreNotJudged) {
    const Surface surface(disk(8));
    const auto& loop = surface.topology.boundary_loops[0];
    const auto pin_some = [&](const std::function<bool(int)>& keep, const std::function<Complex(Complex)>& f) {
        BoundaryCondition boundary;
        for (int i = 0; i < static_cast<int>(loop.size()); ++i)
            if (keep(i))
                boundary.pin(loop[i], f({surface.mesh.positions(loop[i], 0), surface.mesh.positions(loop[i], 1)}));
        return examine(surface, boundary);
    };
    EXPECT_FALSE(examine(surface, {}).refused);
    EXPECT_FALSE(pin_some([](int i) { return i % 2 == 0; }, [](Complex z) { return std::conj(z); }).refused);
    EXPECT_FALSE(pin_some([](int i) { return i < 20; }, [](Complex z) { return std::conj(z); }).refused)
        << "an arc has no orientation";
    EXPECT_TRUE(pin_some([](int i) { return i % 24 < 10; }, [](Complex z) { return z * z; }).refused);
    EXPECT_TRUE(pin_some([](int i) { return i % 2 == 0; }, [](Complex) { return Complex(2, 1); }).says("same image"));
    EXPECT_TRUE(pin_some([](int i) { return i % 24 < 3; },
                         [](Complex z) { return Complex(z.real() * z.imag(), z.imag() * z.imag()); })
                    .refused);
    // A pinned hole keeps others out though the outer boundary is free.
    const Plate plate;
    BoundaryCondition hole;
    for (const int u : plate.surface.topology.boundary_loops[1]) hole.pin(u, plate.at(u));
    EXPECT_FALSE(examine(plate.surface, hole).refused);
    hole.pin(plate.inner_vertex(),
             plate.hole_at(Plate::first_centre) == 1 ? Plate::first_centre : Plate::second_centre);
    EXPECT_TRUE(examine(plate.surface, hole).says("a hole"));
}

TEST(Feasibility, OneFace) {
    Mesh quad;
    quad.positions.resize(4, 2);
    quad.positions << 0, 0, 1, 0, 1, 1, 0, 1;
    quad.faces.add({0, 1, 2, 3});
    const Surface surface(quad);
    BoundaryCondition boundary;
    const std::vector<Complex> dart{0, 2, {0.5, 0.5}, {0, 2}};
    for (int v = 0; v < 4; ++v) boundary.pin(v, dart[v]);
    const Refusal refusal = examine(surface, boundary);
    EXPECT_TRUE(refusal.says("folds at vertex 2"));
    EXPECT_EQ(refusal.indices, (std::vector{0, 1, 2, 3}));
    boundary.images[2] = {2, 2};
    EXPECT_FALSE(examine(surface, boundary).refused);
}

TEST(Feasibility, OtherSurfaces) {
    EXPECT_EQ(examine(Surface(torus(2, 1, 10, 8)), {}).cause, Cause::bad_mesh);
    BoundaryCondition pins;
    pins.pin(0, 1.0);
    pins.pin(1, 2.0);
    const Surface sphere(icosahedral_sphere(1));
    EXPECT_FALSE(examine(sphere, pins).refused);
    pins.images[1] = 1.0;
    EXPECT_TRUE(examine(sphere, pins).refused);
}

/// A ring of quads around a curve, n of them.
Surface ring(int n, const std::function<Complex(double)>& curve) {
    Mesh mesh;
    mesh.positions.resize(2 * n, 2);
    for (int i = 0; i < n; ++i) {
        const Complex z = curve(static_cast<double>(i) / n);
        mesh.positions.row(i) << z.real(), z.imag();
        mesh.positions.row(n + i) << 0.9 * z.real(), 0.9 * z.imag();
        mesh.faces.add({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return Surface(mesh);
}

TEST(Feasibility, LargeBoundariesAreQuick) {
    // Sides that are parallel to the axes, where a sweep along one axis would compare all pairs of a side; and an
    // outline whose edges differ in length by a factor of 1e6.
    const auto square = [](double t) {
        const double s = 4 * t - std::floor(4 * t);
        const Complex corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        const int side = static_cast<int>(4 * t) % 4;
        return corners[side] + s * (corners[(side + 1) % 4] - corners[side]);
    };
    const auto graded = [](double t) {
        return std::polar(1.0, 2 * kPi * (t < 0.5 ? 1e-6 * t : 1e-6 * 0.5 + (t - 0.5) * (2 - 1e-6)));
    };
    const int n = 50000;
    for (const auto& curve : {std::function<Complex(double)>(square), std::function<Complex(double)>(graded)}) {
        const Surface surface = ring(n, curve);
        const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
        const auto start = std::chrono::steady_clock::now();
        EXPECT_FALSE(examine(surface, boundary).refused);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        RecordProperty("seconds", std::to_string(seconds));
        EXPECT_LT(seconds, 5) << "100 000 boundary vertices; a comparison of all pairs takes minutes";
    }
}

}  // namespace
}  // namespace beltrami
