#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/generate/grids.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/space/unrolled_map_step.h>

namespace beltrami {
namespace {

struct Rolled {
    Mesh mesh = cylinder(1.5, 2, 24, 7, Cells::triangles);
    ParametricTarget target = cylinder_target(1.5, 2);
    UnrolledPlaces places = unrolled_places(target, mesh.faces, nearest_points(target, mesh.positions)).value();

    /// Every face as it lies in the plane, so that nothing is lost to chords.
    CornerElements elements() const {
        Positions corners(mesh.faces.corner_count(), 2);
        for (int f = 0; f < mesh.face_count(); ++f)
            for (int j = 0; j < mesh.faces.degree(f); ++j) {
                const int corner = mesh.faces.first_corner(f) + j;
                const Complex at = places.vertices[mesh.faces[f][j]] + places.turns[corner];
                corners.row(corner) << at.real(), at.imag();
            }
        return corner_elements(mesh, corners);
    }

    std::vector<char> rims() const {
        std::vector<char> fixed(static_cast<std::size_t>(mesh.vertex_count()), 0);
        for (int v = 0; v < mesh.vertex_count(); ++v)
            fixed[v] = places.vertices[v].imag() < 1e-9 || places.vertices[v].imag() > 2 - 1e-9;
        return fixed;
    }
};

TEST(UnrolledMap, FacesHangTogetherAcrossTheSeam) {
    const Rolled rolled;
    int turned = 0;
    for (int f = 0; f < rolled.mesh.face_count(); ++f)
        for (int j = 0; j < 3; ++j) {
            const int corner = rolled.mesh.faces.first_corner(f) + j, first = rolled.mesh.faces.first_corner(f);
            const Complex away = rolled.places.vertices[rolled.mesh.faces[f][j]] + rolled.places.turns[corner] -
                                 rolled.places.vertices[rolled.mesh.faces[f][0]] - rolled.places.turns[first];
            EXPECT_LT(std::abs(away), 0.6) << f;
            turned += rolled.places.turns[corner] != 0.0;
        }
    EXPECT_GT(turned, 0);
    const Positions back = positions_of(rolled_up(rolled.target, rolled.places.vertices));
    EXPECT_LT((back - rolled.mesh.positions).cwiseAbs().maxCoeff(), 1e-12);
}

// x + iy → x + a y + i b y, which closes up on the cylinder: one coefficient in the plane's frame.
TEST(UnrolledMap, ShearsAreExact) {
    Rolled rolled;
    const CornerElements elements = rolled.elements();
    UnrolledPlaces sheared = rolled.places;
    const double a = 0.4, b = 0.7;
    for (Complex& z : sheared.vertices) z = {z.real() + a * z.imag(), b * z.imag()};
    const Eigen::VectorXcd exact = sheared.vertices;
    const std::vector<char> fixed = rolled.rims();
    for (Eigen::Index v = 0; v < exact.size(); ++v)
        if (!fixed[static_cast<std::size_t>(v)]) sheared.vertices[v] += Complex(0.3 * std::sin(7.0 * v), 0.2);
    const Complex p = 0.5 * Complex(1 + b, -a), q = 0.5 * Complex(1 - b, a), mu = q / p;
    Eigen::VectorXcd wanted(elements.operators.sample_count());
    for (int s = 0; s < wanted.size(); ++s) {  // into the frame of the first edge
        const Complex edge = elements.edge_direction[rolled.mesh.faces.first_corner(elements.operators.faces[s])];
        EXPECT_LT(std::abs(edge - 1.0), 1e-12);
        const int first = rolled.mesh.faces.first_corner(elements.operators.faces[s]);
        const Complex along = rolled.places.vertices[rolled.mesh.faces[elements.operators.faces[s]][1]] +
                              rolled.places.turns[first + 1] -
                              rolled.places.vertices[rolled.mesh.faces[elements.operators.faces[s]][0]];
        const Complex direction = along / std::abs(along);
        wanted[s] = mu / (direction * direction);
    }
    const Eigen::VectorXcd map = unrolled_map(rolled.mesh, elements, sheared, fixed, wanted);
    EXPECT_LT((map - exact).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(UnrolledMap, TheIterationSpreadsLittleWhereLeastSquaresFolds) {
    const Mesh mesh = cylinder(1, 2, 48, 16, Cells::triangles);
    const ParametricTarget target = cylinder_target(1, 2);
    const CornerElements elements = corner_elements(mesh);
    Positions lowered = mesh.positions;
    std::vector<char> fixed(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double z = mesh.positions(v, 2), angle = std::atan2(mesh.positions(v, 1), mesh.positions(v, 0));
        fixed[v] = z < 1e-9 || z > 2 - 1e-9;
        if (z > 1) lowered(v, 2) = fixed[v] ? 2 - 0.8 * (1 - std::cos(angle)) : z;
    }
    const UnrolledPlaces places = unrolled_places(target, mesh.faces, nearest_points(target, lowered)).value();
    UniformOptions options;
    options.max_iterations = 80;
    const UnrolledMap map = uniform_unrolled_map(mesh, elements, places, fixed, options);
    const auto measured = [&](const Eigen::VectorXcd& vertices) {
        const Target::Points points = rolled_up(target, vertices);
        return distortion(elements.operators, positions_of(points), normals_of(points));
    };
    const Distortion first = measured(map.first), last = measured(map.vertices);
    EXPECT_GT(first.flipped.size(), 40U);
    EXPECT_TRUE(last.flipped.empty());
    EXPECT_LT(last.standard_deviation, 0.0225);
    EXPECT_NEAR(last.mean, 0.563, 0.005);
}

// From a start without folds, where the least-squares map has some, a step flips nothing.
TEST(UnrolledMap, StepsFlipNothing) {
    const Mesh mesh = cylinder(1, 2, 48, 16, Cells::triangles);
    const ParametricTarget target = cylinder_target(1, 2);
    const CornerElements elements = corner_elements(mesh);
    Positions lowered = mesh.positions;  // sheared downwards
    std::vector<char> fixed(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double z = mesh.positions(v, 2), angle = std::atan2(mesh.positions(v, 1), mesh.positions(v, 0));
        fixed[v] = z < 1e-9 || z > 2 - 1e-9;
        lowered(v, 2) = z * (1 - 0.4 * (1 - std::cos(angle)));
    }
    const UnrolledPlaces places = unrolled_places(target, mesh.faces, nearest_points(target, lowered)).value();
    UnrolledMapStep step(mesh, elements, places, fixed);
    const auto largest = [&] { return beltrami_coefficient(step.derivatives()).cwiseAbs().maxCoeff(); };
    ASSERT_LT(largest(), 1);
    step.weigh(Eigen::VectorXcd::Ones(elements.operators.sample_count()));
    double last = 0;
    for (int i = 0; i < 5; ++i) {
        step.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()), 0);
        EXPECT_LT(largest(), 1) << i;
        last = step.last_length();
    }
    EXPECT_GT(last, 0);
    // The Gauss-Newton step of the energy goes where that falls.
    UnrolledProblem problem(mesh, elements, places, fixed);
    const std::vector<double> weights(static_cast<std::size_t>(elements.operators.sample_count()), 1.0);
    const BarrierEnergy energy(Eigen::VectorXcd::Zero(elements.operators.sample_count()), weights);
    const auto value = [&] {
        const MapDerivatives map = problem.derivatives();
        double sum = 0;
        for (int s = 0; s < map.dz.size(); ++s) sum += energy.value(plane_frame(map.dz[s], map.dzbar[s]), s);
        return sum;
    };
    const double before = value();
    const Eigen::VectorXcd way = problem.step(energy);
    problem.set_map(problem.map() + 0.1 * way);
    EXPECT_LT(value(), before);
}

TEST(UnrolledMap, ATorusCannotBeUnrolled) {
    EXPECT_FALSE(torus_target(2, 1).unrolled());
    const std::optional<ParametricTarget::Unrolled> plane = cylinder_target(2, 3).unrolled();
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->turns.x(), 2 * kTurn, 1e-12);
    EXPECT_EQ(plane->turns.y(), 0);
}

}  // namespace
}  // namespace beltrami
