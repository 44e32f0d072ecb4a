#include <array>
#include <clocale>
#include <cmath>
#include <locale>

#include <beltrami/io/read_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

Mesh obj(std::string_view text) {
    return read_obj(text, "t.obj").mesh;
}

void expect_obj_error(const std::string& part, std::string_view text) {
    expect_error(Cause::unreadable, part, [&] { read_obj(text, "t.obj"); });
}

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST(ReadObj, KeepsOrderTrianglesAndQuads) {
    const LoadedMesh loaded = read_obj("v 0 0 0\nv 1 0 .5\nv 1 1 0\nv 0 1 0\nv 9 9 9\nf 4 1 2 3\nf 3 2 1\n", "t.obj");
    expect_same_bits(loaded.mesh.positions, rows({{0, 0, 0}, {1, 0, .5}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}}));
    ASSERT_EQ(loaded.mesh.face_count(), 2);
    EXPECT_EQ(corners_of(loaded.mesh, 0), (std::vector{3, 0, 1, 2}));
    EXPECT_EQ(corners_of(loaded.mesh, 1), (std::vector{2, 1, 0}));
    EXPECT_FALSE(loaded.mesh.texture);
    EXPECT_TRUE(loaded.warnings.empty());
}

TEST(ReadObj, TakesEveryFormOfACorner) {
    const Mesh mesh =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0.25\nvt .5 .75\nvt 1 2 3\n"
            "f 1/1 2/2 3/3\nf 1//1 2//1 3//1\nf 1/3/1 2/2/1 3/1/1\nf 1 2 3\nf 1/2/ 2/ 3\n");
    ASSERT_TRUE(mesh.texture);
    expect_same_bits(mesh.texture->points, rows({{.25, 0}, {.5, .75}, {1, 2}}));
    EXPECT_EQ(mesh.texture->corners, (std::vector{0, 1, 2, -1, -1, -1, 2, 1, 0, -1, -1, -1, 1, -1, -1}));
    ASSERT_EQ(mesh.face_count(), 5);
    for (int face = 0; face < 5; ++face) EXPECT_EQ(corners_of(mesh, face), (std::vector{0, 1, 2}));
}

TEST(ReadObj, TextureThatNoFaceUsesIsNone) {
    EXPECT_FALSE(obj("v 0 0 0\nvt 0 0\nf 1 1 1\n").texture);
}

TEST(ReadObj, NegativeIndicesCountBackFromTheLineTheyStandIn) {
    const Mesh mesh = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf -3/-1 -2/-2 -1/-1\nv 2 2 2\nf -1 -2 -3\n");
    EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
    EXPECT_EQ(corners_of(mesh, 1), (std::vector{3, 2, 1}));
    EXPECT_EQ(mesh.texture->corners, (std::vector{1, 0, 1, -1, -1, -1}));
}

TEST(ReadObj, FacesMayComeBeforeTheirVertices) {
    const Mesh mesh = obj("f 1/1 2/1 3/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n");
    EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
    expect_obj_error("t.obj:2: a face names vertex 4, but the file has 3", "v 0 0 0\nf 1 2 4\nv 1 0 0\nv 0 1 0\n");
}

TEST(ReadObj, LineEndsCommentsTabsAndContinuations) {
    const Mesh wanted = obj(std::string(square) + "f 1 2 3\n");
    for (const std::string_view text : {
             "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
             "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3\r",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3",
             "\tv\t0 0\t0 \n v 1 0 0\t\nv 1   1 0\nv 0 1 0\n\n  \nf 1\t2  3  \n",
             "# C:\\models\\\nv 0 0 0 # first\nv 1 0 0\nv 1 1 0\n#v 5 5 5\nv 0 1 0\nf 1 2 3#",
             "v 0 0 \\\n0\nv 1 0\\\n 0\nv 1 1 0\nv 0 1 0\nf 1 \\\r\n 2 \\\n\\\n 3\n",
             "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n",
             "mtllib a.mtl\no x\ng a b\ns off\nusemtl m\nv 0 0 0 1\nv 1 0 0 .1 .2 .3\nvn 0 0 1\nv 1 1 0 1 1 1 1\n"
             "v 0 1 0\nl 1 2 \\\nl\np 1\ncurv 0 1 1\nf 1 2 3\n",
         }) {
        const std::string shown(text);
        SCOPED_TRACE(shown);
        if (shown.ends_with('#')) {  // "3#" is no number: only a word that begins with # is a comment
            expect_obj_error("t.obj:7: '3#' is not a corner", text);
        } else {
            expect_same(obj(text), wanted);
        }
    }
}

TEST(ReadObj, LineOfAnErrorIsRightBehindContinuations) {
    expect_obj_error("t.obj:4:", "v 0 0 \\\n0\n\nv 1 x 0\n");
    expect_obj_error("t.obj:3:", "v 0 0 0\r\nv 1 0 0\r\nv 1 x 0\r\n");
}

TEST(ReadObj, NumbersOfEverySpelling) {
    const Mesh mesh =
        obj("v +1 -0 1e-3\nv 4.9e-324 1.7976931348623157e308 .5\nv nan inf -Infinity\nv 1. -nan(ind) +.5E+1\n");
    EXPECT_EQ(mesh.positions(0, 0), 1.0);
    EXPECT_TRUE(std::signbit(mesh.positions(0, 1)));
    EXPECT_EQ(mesh.positions(0, 2), 1e-3);
    EXPECT_EQ(mesh.positions(1, 0), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(mesh.positions(1, 1), std::numeric_limits<double>::max());
    EXPECT_TRUE(std::isnan(mesh.positions(2, 0)));
    EXPECT_EQ(mesh.positions(2, 1), std::numeric_limits<double>::infinity());
    EXPECT_EQ(mesh.positions(2, 2), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(mesh.positions(3, 1)));
    EXPECT_EQ(mesh.positions(3, 2), 5.0);
}

TEST(ReadObj, LocaleChangesNothing) {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    const bool german = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;  // many machines have none
    const Mesh mesh = obj("v 1234.5 -0.25 1e3\nv 0 0 0\nv 1 0 0\nf 1 2 3\n");
    expect_obj_error("'0,5' is not a number", "v 0,5 0 0\n");
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
    expect_same_bits(mesh.positions.topRows(1), rows({{1234.5, -.25, 1000}}));
    RecordProperty("german_locale", german);
}

TEST(ReadObj, LargeFacesAreCutIntoTrianglesAndNamed) {
    std::string text = std::string(square) + "v -1 .5 0\nvt 0 0\nusemtl a\nf 1 2 3 4 5\nusemtl b\nf 1/1 2/1 3/1\n";
    const LoadedMesh one = read_obj(text, "t.obj");
    ASSERT_EQ(one.mesh.face_count(), 4);
    EXPECT_EQ(corners_of(one.mesh, 3), (std::vector{0, 1, 2}));
    EXPECT_EQ(one.mesh.texture->corners, (std::vector{-1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0}));
    // Each triangle is a part of the polygon: areas add up, and all look the same way.
    double area = 0;
    for (int f = 0; f < 3; ++f) {
        const double part = face_vector_area(one.mesh, f).z();
        EXPECT_GT(part, 0);
        area += part;
    }
    EXPECT_NEAR(area, 1.5, 1e-14);
    ASSERT_EQ(one.attributes.face_states.size(), 4U);
    EXPECT_EQ(one.attributes.states[one.attributes.face_states[2]].at("usemtl"), "a");
    EXPECT_EQ(one.attributes.states[one.attributes.face_states[3]].at("usemtl"), "b");
    ASSERT_EQ(one.warnings.size(), 1U);
    EXPECT_NE(one.warnings[0].sentence.find("t.obj:8: a face with 5 corners"), std::string::npos)
        << one.warnings[0].sentence;

    for (int i = 0; i < 100; ++i) text += "f 1 2 3 4 5 1\n";
    const LoadedMesh many = read_obj(text, "t.obj");
    ASSERT_EQ(many.warnings.size(), 11U);
    EXPECT_NE(many.warnings[10].sentence.find("91 further faces"), std::string::npos) << many.warnings[10].sentence;
}

TEST(ReadObj, ErrorsNameFileAndLine) {
    const std::string head(square);
    expect_obj_error("t.obj:5: a face names 2 corners", head + "f 1 2\n");
    expect_obj_error("t.obj:5: a face names 0 corners", head + "f\n");
    expect_obj_error("t.obj:5: a face names vertex 5, but the file has 4", head + "f 1 2 5\n");
    expect_obj_error("t.obj:5: a face names vertex 5, but the file has 4", head + "f 1 2 3 4 5\n");
    expect_obj_error("t.obj:5: a face names vertex 0, but indices count from 1", head + "f 0 1 2\n");
    expect_obj_error("t.obj:5: a face names vertex -5, but only 4", head + "f 1 2 -5\n");
    expect_obj_error("which is too large", head + "f 1 2 2147483648\n");
    expect_obj_error("t.obj:5: '9223372036854775808' is not a corner", head + "f 1 2 9223372036854775808\n");
    expect_obj_error("but only 4", head + "f 1 2 -9223372036854775808\n");
    expect_obj_error("t.obj:5: a face names texture point 1, but the file has 0", head + "f 1/1 2/1 3/1\n");
    expect_obj_error("t.obj:5: '1/2/3/4' is not a corner", head + "f 1/2/3/4 2 3\n");
    expect_obj_error("t.obj:5: '1.5' is not a corner", head + "f 1.5 2 3\n");
    expect_obj_error("t.obj:1: the line ends where a coordinate should follow", "v 1 2\n");
    expect_obj_error("t.obj:1: '2x' is not a number", "v 1 2x 3\n");
    expect_obj_error("t.obj:1: '+-2' is not a number", "v 1 +-2 3\n");
    expect_obj_error("t.obj:1: '1e999' is not a number in range", "v 1 1e999 3\n");
    expect_obj_error("t.obj:1: the line ends", "vt\n");
    expect_obj_error("t.obj:1: '?ELF' is not a statement",
                     "\x7F"
                     "ELF");
    expect_obj_error("t.obj: the file holds no vertex", "");
    expect_obj_error("t.obj: the file holds no vertex", "# only a comment");
    try {
        read_obj("v 0 0 0\nv a b c\n", "t.obj");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), std::vector<int>{1});
    }
}

}  // namespace beltrami::io_tests
