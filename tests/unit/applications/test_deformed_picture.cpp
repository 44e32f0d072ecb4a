#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <beltrami/applications/deformed_picture.h>
#include <beltrami/generate/round_domains.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// Red grows to the right, green upwards; opaque.
Picture ramps(int size) {
    Picture picture{size, size, {}};
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
            for (const int value : {255 * column / (size - 1), 255 - 255 * row / (size - 1), 0, 255})
                picture.rgba.push_back(static_cast<std::uint8_t>(value));
    return picture;
}

Eigen::VectorXcd coordinates(const Mesh& mesh) {
    Eigen::VectorXcd z(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) z[v] = {mesh.positions(v, 0), mesh.positions(v, 1)};
    return z;
}

const PictureOptions kUnitSquare{.place = {0, {1, 1}}, .width = 64};

TEST(DeformedPicture, TheIdentityLeavesItAsItIs) {
    const Surface source(test::jittered_square(8));
    const Picture picture = ramps(64);
    for (const bool smooth : {true, false}) {
        PictureOptions options = kUnitSquare;
        options.smooth = smooth;
        const Picture result = deformed_picture(picture, source, coordinates(source.mesh), options);
        ASSERT_EQ(result.width, 64);
        ASSERT_EQ(result.height, 64);
        for (int row = 0; row < 64; ++row)
            for (int column = 0; column < 64; ++column)
                for (int c = 0; c < 4; ++c)
                    ASSERT_NEAR(result.at(column, row)[c], picture.at(column, row)[c], c == 3 ? 0 : 3)
                        << column << " " << row;
    }
}

TEST(DeformedPicture, AffineMapsCarryEveryPixel) {
    const Surface source(test::jittered_square(8));
    Eigen::VectorXcd map = coordinates(source.mesh);
    for (Complex& w : map) w = Complex(2 * w.real(), w.imag() + 0.5 * w.real());
    PictureOptions options = kUnitSquare;
    options.width = 96;
    const Picture result = deformed_picture(ramps(256), source, map, options);
    ASSERT_EQ(result.height, 72);
    const double pixel = 2.0 / 96;
    for (int row = 2; row < 70; ++row)
        for (int column = 2; column < 94; ++column) {
            const double u = pixel * (column + 0.5), v = 1.5 - pixel * (row + 0.5), x = u / 2,
                         y = v - 0.5 * x * 2 * 0.5;
            if (y < 0.05 || y > 0.95) continue;
            ASSERT_NEAR(result.at(column, row)[0], 255 * x, 3);
            ASSERT_NEAR(result.at(column, row)[1], 255 * y, 3);
        }
    EXPECT_EQ(result.at(2, 2)[3], 0);    // above the image
    EXPECT_EQ(result.at(93, 69)[3], 0);  // below it
}

// What single vertices do does not show: a map with noise is as near to the exact one as its smooth part.
TEST(DeformedPicture, WrinklesDoNotShow) {
    const int n = 24;
    const Mesh mesh = test::jittered_square(n);
    const Surface source(mesh);
    const auto exact = [](Complex z) { return z + 0.1 * Complex(std::sin(3 * z.imag()), std::sin(3 * z.real())); };
    Eigen::VectorXcd map = coordinates(mesh);
    for (int v = 0; v < map.size(); ++v) {
        const double wrinkle = source.topology.on_boundary[v] ? 0 : 0.2 / n;
        map[v] = exact(map[v]) + wrinkle * std::polar(1.0, 2.0 * v * v);
    }
    // How far the picture is from the one of the exact inverse, sampled on its pixels.
    const auto error = [&](bool smooth) {
        PictureOptions options = kUnitSquare;
        options.width = 400;
        options.smooth = smooth;
        const Picture result = deformed_picture(ramps(512), source, map, options);
        double low_x = 1e9, high_x = -1e9, high_y = -1e9;
        for (const Complex w : map) {
            low_x = std::min(low_x, w.real());
            high_x = std::max(high_x, w.real());
            high_y = std::max(high_y, w.imag());
        }
        const double pixel = (high_x - low_x) / 400;
        double sum = 0;
        int count = 0;
        for (int i = 30; i < 170; ++i)
            for (int j = 30; j < 170; ++j) {
                const Complex w = exact(Complex(i / 200.0, j / 200.0));
                const int column = static_cast<int>((w.real() - low_x) / pixel),
                          row = static_cast<int>((high_y - w.imag()) / pixel);
                sum += std::hypot(result.at(column, row)[0] / 255.0 - i / 200.0,
                                  result.at(column, row)[1] / 255.0 - j / 200.0);
                ++count;
            }
        return sum / count;
    };
    EXPECT_LT(error(true), 0.85 * error(false));  // .75 measured; pixels and colours of 8 bits are a third of both
}

TEST(DeformedPicture, HolesStayOpenAndBadInputIsRefused) {
    const Surface source(test::jittered_square(4));
    const Eigen::VectorXcd map = coordinates(source.mesh);
    PictureOptions options = kUnitSquare;
    options.width = 0;
    EXPECT_EQ(test::cause_of([&] { deformed_picture(ramps(4), source, map, options); }), Cause::bad_option);
    options = {};
    EXPECT_EQ(test::cause_of([&] { deformed_picture(ramps(4), source, map, options); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { deformed_picture({}, source, map, kUnitSquare); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { deformed_picture(ramps(4), source, map.head(3), kUnitSquare); }), Cause::bad_option);
    Mesh bent = source.mesh;
    bent.positions.conservativeResize(Eigen::NoChange, 3);
    bent.positions.col(2) = bent.positions.col(0).array().square();
    EXPECT_EQ(test::cause_of([&] { deformed_picture(ramps(4), Surface(bent), map, kUnitSquare); }), Cause::bad_mesh);

    const Surface ring(annulus(0.4, 1, 48));
    options = {.place = {{-1, -1}, {1, 1}}, .width = 50};
    const Picture result = deformed_picture(ramps(16), ring, coordinates(ring.mesh), options);
    EXPECT_EQ(result.at(25, 25)[3], 0);
    EXPECT_EQ(result.at(25, 5)[3], 255);
}

}  // namespace
}  // namespace beltrami
