#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/report/drawing.h>
#include <beltrami/report/page.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

using Json = nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A PNG of one red and one blue pixel.
constexpr unsigned char kTwoPixels[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x7b, 0x40, 0xe8, 0xdd, 0x00, 0x00, 0x00,
    0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xb8, 0x63, 0xa3, 0xa1, 0x11, 0x70, 0x02, 0x00, 0x08, 0xdb,
    0x02, 0x81, 0xc5, 0x79, 0xf0, 0x36, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
const std::string two_pixels(reinterpret_cast<const char*>(kTwoPixels), sizeof(kTwoPixels));

enum class Faces { triangles, quads };

/// A bumpy square of n×n cells, far from the origin.
Mesh bumpy_square(int n, Faces kind = Faces::triangles) {
    Mesh mesh;
    mesh.positions.resize((n + 1) * (n + 1), 3);
    for (int row = 0; row <= n; ++row) {
        for (int column = 0; column <= n; ++column) {
            const double x = 2.0 * column / n - 1.0;
            const double y = 2.0 * row / n - 1.0;
            const int v = row * (n + 1) + column;
            mesh.positions.row(v) << 1e6 + x, y, 0.2 * std::cos(4.0 * x) * std::sin(3.0 * y + 1.0);
            if (row == n || column == n) continue;
            if (kind == Faces::quads) {
                mesh.faces.add({v, v + 1, v + n + 2, v + n + 1});
            } else {
                mesh.faces.add({v, v + 1, v + n + 2});
                mesh.faces.add({v, v + n + 2, v + n + 1});
            }
        }
    }
    return mesh;
}

/// The mesh seen from above, made up |μ| = 0.3.
PageMap flat_map(const Mesh& mesh, const std::string& name = "extremal") {
    return {name, mesh.positions.leftCols(2), Eigen::VectorXd::Constant(mesh.face_count(), 0.3)};
}

PageContent content_of(const Mesh& mesh, std::vector<PageMap> maps) {
    return {.source = mesh,
            .maps = std::move(maps),
            .history_k = {0.4, 0.31, 0.3},
            .history_change = {0.1, 0.01, nan},
            .history_largest = {1.7, 0.5, 0.4},
            .record_json = R"({"schema":1,"map":{"K":1.857,"K_lower":1.85,"K_max":null}})",
            .title = "bumpy square"};
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t from = text.find(begin) + begin.size();
    return text.substr(from, text.find(end, from) - from);
}

Json data_of(const std::string& html) {  // its numbers and what it draws
    Json data = Json::parse(between(html, R"(<script type="application/json" id="data">)", "</script>"));
    const Json numbers = data["maps"];
    data.update(Json::parse(between(html, R"(<script type="application/json" id="mesh">)", "</script>")));
    EXPECT_EQ(data["maps"].size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) data["maps"][i].update(numbers[i]);
    return data;
}

std::vector<std::uint32_t> decode_words(const std::string& base64) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint32_t> bytes;
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : base64.substr(0, base64.find('='))) {
        bits = (bits << 6) | static_cast<std::uint32_t>(letters.find(c));
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back((bits >> held) & 0xffU);
    }
    EXPECT_EQ(base64.size() % 4, 0U);
    EXPECT_EQ(bytes.size() % 4, 0U);
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
        words.push_back(bytes[i] | bytes[i + 1] << 8 | bytes[i + 2] << 16 | bytes[i + 3] << 24);
    }
    return words;
}

std::vector<float> decode_floats(const std::string& base64) {
    std::vector<float> floats;
    for (const std::uint32_t word : decode_words(base64)) floats.push_back(std::bit_cast<float>(word));
    return floats;
}

double histogram_total(const Json& histogram) {
    double total = 0.0;
    for (const double share : histogram["bins"]) total += share;
    for (const char* name : {"above", "flipped", "undefined"}) total += histogram[name].get<double>();
    return total;
}

TEST(Page, FetchesNothing) {
    const Mesh mesh = bumpy_square(4);
    const std::string html = render_page(content_of(mesh, {flat_map(mesh)}));
    // The browser is told to fetch nothing, and the page outside its scripts, where names of XML's are, asks for
    // nothing.
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
    std::string around = html;
    for (const char* tag : {"<script type=\"module\">", "<script type=\"text/plain\" id=\"drawing\">"}) {
        const std::size_t script = around.find(tag);
        ASSERT_NE(script, std::string::npos) << tag;
        around.erase(script, around.find("</script>", script) - script);
    }
    for (const char* outside : {"http:", "https:", "//www", "@import", "url(", "<link", "src=", "import("}) {
        EXPECT_EQ(around.find(outside), std::string::npos) << outside;
    }
    for (const char* mark : {"@TITLE@", "@HEADING@", "@DATA@"}) {
        EXPECT_EQ(html.find(mark), std::string::npos) << mark;
    }
    EXPECT_NE(html.find("<title>bumpy square</title>"), std::string::npos);
    EXPECT_NE(html.find("<h1>bumpy square</h1>"), std::string::npos);
    EXPECT_TRUE(html.ends_with("</html>\n"));
}

TEST(Page, EscapesEveryText) {
    const Mesh mesh = bumpy_square(2);
    const std::string hostile = "</script><b>&\"@DATA@<!--\xff";
    PageContent content = content_of(mesh, {flat_map(mesh, hostile)});
    content.title = "</title>" + hostile;
    content.record_json = R"({"warnings":["</script><b>"]})";
    const std::string html = render_page(content);
    const std::string own = render_page(content_of(mesh, {flat_map(mesh)}));  // its script may speak of such things
    for (const std::string tag : {"<b>", "<!--", "</script>"}) {
        const auto count = [&](const std::string& text) {
            int found = 0;
            for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) ++found;
            return found;
        };
        EXPECT_EQ(count(html), count(own)) << tag;
    }
    EXPECT_EQ(between(html, "<title>", "</title>"),
              "&lt;/title&gt;&lt;/script&gt;&lt;b&gt;&amp;&quot;@DATA@&lt;!--\xef\xbf\xbd");
    const Json data = data_of(html);
    EXPECT_EQ(data["maps"][0]["name"], "</script><b>&\"@DATA@<!--\xef\xbf\xbd");
    EXPECT_EQ(data["record"]["warnings"][0], "</script><b>");
}

TEST(Page, ArraysHaveTheSizesOfTheMesh) {
    const Mesh mesh = bumpy_square(5);
    const Json data = data_of(render_page(content_of(mesh, {flat_map(mesh), flat_map(mesh, "harmonic")})));
    EXPECT_EQ(data["faces"], 50);
    EXPECT_EQ(data["coarsened"], false);
    EXPECT_FALSE(data.contains("face"));
    const auto triangles = decode_words(data["triangles"]);
    ASSERT_EQ(triangles.size(), 150U);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        EXPECT_EQ(triangles[i], static_cast<std::uint32_t>(mesh.faces.vertices()[i]));
    }
    EXPECT_EQ(data["source"]["dimension"], 3);
    EXPECT_EQ(decode_floats(data["source"]["coordinates"]).size(), 108U);
    ASSERT_EQ(data["maps"].size(), 2U);
    for (const Json& map : data["maps"]) {
        EXPECT_EQ(map["dimension"], 2);
        EXPECT_EQ(decode_floats(map["coordinates"]).size(), 72U);
        EXPECT_EQ(decode_floats(map["abs_mu"]), std::vector<float>(50, 0.3F));
        EXPECT_NEAR(map["p99"], 0.3, 1e-15);
        for (const char* of : {"area", "faces"}) EXPECT_NEAR(histogram_total(map["histogram"][of]), 1.0, 1e-12);
    }
    EXPECT_TRUE(data["history"]["change"][2].is_null());
    EXPECT_EQ(data["history"]["largest"][0], 1.7);
    EXPECT_EQ(data["record"]["map"]["K"], 1.857);
}

TEST(Page, PositionsKeepTheirDigitsFarFromTheOrigin) {
    const Mesh mesh = bumpy_square(5);
    const Json data = data_of(render_page(content_of(mesh, {flat_map(mesh)})));
    const auto points = decode_floats(data["source"]["coordinates"]);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_NEAR(points[static_cast<std::size_t>(3 * v)], mesh.positions(v, 0) - 1e6, 1e-7);
        EXPECT_NEAR(points[static_cast<std::size_t>(3 * v + 1)], mesh.positions(v, 1), 1e-7);
    }
}

TEST(Page, UndefinedAndFlippedFacesAreCountedApart) {
    const Mesh mesh = bumpy_square(10);
    PageMap map = flat_map(mesh);
    map.map.row(7).setConstant(nan);
    map.abs_mu[0] = nan;
    map.abs_mu[1] = 1.5;
    map.abs_mu[2] = infinity;
    const Json data = data_of(render_page(content_of(mesh, {map})));
    const auto mu = decode_floats(data["maps"][0]["abs_mu"]);
    EXPECT_TRUE(std::isnan(mu[0]));
    EXPECT_EQ(mu[1], 1.5F);
    EXPECT_TRUE(std::isinf(mu[2]));
    const auto points = decode_floats(data["maps"][0]["coordinates"]);
    EXPECT_TRUE(std::isnan(points[14]));
    EXPECT_EQ(points[0], -1.0F);
    const Json& histogram = data["maps"][0]["histogram"]["area"];
    const Json& of_faces = data["maps"][0]["histogram"]["faces"];
    EXPECT_NEAR(of_faces["undefined"], 1.0 / mesh.face_count(), 1e-12);
    EXPECT_NEAR(of_faces["flipped"], 2.0 / mesh.face_count(), 1e-12);
    const auto area = [&](int face) { return face_vector_area(mesh, face).norm(); };
    double total = 0.0;
    for (int face = 0; face < mesh.face_count(); ++face) total += area(face);
    EXPECT_NEAR(histogram["undefined"], area(0) / total, 1e-12);
    EXPECT_NEAR(histogram["flipped"], (area(1) + area(2)) / total, 1e-12);
    EXPECT_NEAR(histogram_total(histogram), 1.0, 1e-12);
}

TEST(Page, QuadsAreSplitForDrawing) {
    const Mesh mesh = bumpy_square(4, Faces::quads);
    const Json data = data_of(render_page(content_of(mesh, {flat_map(mesh)})));
    EXPECT_EQ(data["faces"], 16);
    EXPECT_EQ(decode_words(data["triangles"]).size(), 96U);
    EXPECT_EQ(decode_floats(data["maps"][0]["abs_mu"]).size(), 32U);
    const auto faces = decode_words(data["face"]);
    ASSERT_EQ(faces.size(), 32U);
    for (std::size_t t = 0; t < faces.size(); ++t) EXPECT_EQ(faces[t], t / 2);
}

TEST(Page, ImageInSpaceKeepsThreeCoordinatesAFlatOneTwo) {
    const Mesh mesh = bumpy_square(3);
    PageMap space{"space", mesh.positions, Eigen::VectorXd::Zero(mesh.face_count())};
    PageMap flat = space;
    flat.map.col(2).setZero();
    const Json data = data_of(render_page(content_of(mesh, {space, flat})));
    EXPECT_EQ(data["maps"][0]["dimension"], 3);
    EXPECT_EQ(decode_floats(data["maps"][0]["coordinates"]).size(), 48U);
    EXPECT_EQ(data["maps"][1]["dimension"], 2);
    EXPECT_EQ(decode_floats(data["maps"][1]["coordinates"]).size(), 32U);
}

TEST(Page, LargeMeshIsCoarsenedForDrawingOnly) {
    const Mesh mesh = bumpy_square(100);
    PageMap map = flat_map(mesh);
    for (int face = 0; face < mesh.face_count(); face += 2) map.abs_mu[face] = 0.1;
    PageContent content = content_of(mesh, {map});
    content.drawn_faces = 4000;
    const Json data = data_of(render_page(content));
    EXPECT_EQ(data["faces"], 20000);
    EXPECT_EQ(data["coarsened"], true);
    const auto triangles = decode_words(data["triangles"]);
    EXPECT_LE(triangles.size() / 3, 4000U);
    EXPECT_GE(triangles.size() / 3, 1000U);
    const std::size_t vertices = decode_floats(data["source"]["coordinates"]).size() / 3;
    EXPECT_EQ(decode_floats(data["maps"][0]["coordinates"]).size() / 2, vertices);
    for (const std::uint32_t vertex : triangles) EXPECT_LT(vertex, vertices);
    EXPECT_EQ(decode_words(data["face"]).size(), triangles.size() / 3);
    // All faces are in the histogram: two bins of about half the area each.
    double tall = 0.0;
    for (const double share : data["maps"][0]["histogram"]["area"]["bins"]) tall += share > 0.49 ? share : 0.0;
    EXPECT_NEAR(tall, 1.0, 1e-12);
}

TEST(Page, TrajectoriesGoWithTheTriangles) {
    const Mesh mesh = bumpy_square(3);
    PageMap map = flat_map(mesh);
    PageDifferential& phi = map.differential.emplace();
    phi.angles = Eigen::VectorXd::LinSpaced(mesh.face_count(), 0.1, 3.1);
    phi.angles[4] = nan;
    const auto v = mesh.faces[7];
    phi.points.push_back({{7, {v[0], v[1], v[2]}, {0.25, 0.25, 0.5}}, 2, false});
    const Json data = data_of(render_page(content_of(mesh, {map})))["maps"][0];
    const std::vector<std::uint32_t> pairs = decode_words(data["directions"]);  // 18 numbers of 16 bits
    ASSERT_EQ(pairs.size(), 9U);
    for (int face = 0; face < mesh.face_count(); ++face) {
        const std::uint32_t value = (pairs[static_cast<std::size_t>(face / 2)] >> (16 * (face % 2))) & 0xffffU;
        if (face == 4) {
            EXPECT_EQ(value, 0xffffU);
        } else {
            EXPECT_NEAR(value * std::numbers::pi / 65535, phi.angles[face], 1e-4);
        }
    }
    const Json& point = data["critical_points"][0];
    EXPECT_EQ(point["order"], 2);
    EXPECT_EQ(point["vertices"], (std::vector<int>{v[0], v[1], v[2]}));
    EXPECT_EQ(point["weights"], (std::vector<double>{0.25, 0.25, 0.5}));
}

TEST(Page, HalvesOfAQuadHaveTheDirectionOfTheQuad) {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0.0, 0.0, 2.0, 0.0, 2.5, 1.0, 0.5, 0.3;  // split along 1–3
    mesh.faces.add({0, 1, 2, 3});
    PageMap map{"map", mesh.positions, Eigen::VectorXd::Zero(1)};
    map.differential.emplace().angles = Eigen::VectorXd::Constant(1, 0.5);
    PageContent content = content_of(mesh, {map});
    const Json data = data_of(render_page(content))["maps"][0];
    const std::uint32_t both = decode_words(data["directions"])[0];
    // The first triangle is (1, 2, 3), the second (1, 3, 0): their first edges point to atan2(1, .5) and atan2(.3,
    // −1.5).
    const auto expected = [](double edge) { return std::fmod(0.5 - edge + 2 * std::numbers::pi, std::numbers::pi); };
    EXPECT_NEAR((both & 0xffffU) * std::numbers::pi / 65535, expected(std::atan2(1.0, 0.5)), 1e-4);
    EXPECT_NEAR((both >> 16U) * std::numbers::pi / 65535, expected(std::atan2(0.3, -1.5)), 1e-4);
}

/// φ = z on a square: the angles of its trajectories are −arg(z)/2, and it has one zero.
TEST(PageDifferential, OfZ) {
    Mesh mesh = bumpy_square(10);
    mesh.positions.col(0).array() += 0.05 - 1e6;
    mesh.positions.col(2).setZero();
    const Surface surface(mesh);
    const QuadraticDifferential z = differential_of(surface, [](Complex at) { return at; });
    const PageDifferential found = page_differential(surface, z.at_samples(surface), z);
    for (int face = 0; face < mesh.face_count(); ++face) {
        const auto v = mesh.faces[face];
        const Eigen::Vector3d middle = (mesh.point(v[0]) + mesh.point(v[1]) + mesh.point(v[2])) / 3;
        const Eigen::Vector3d edge = mesh.point(v[1]) - mesh.point(v[0]);
        const double expected = -0.5 * std::atan2(middle.y(), middle.x()) - std::atan2(edge.y(), edge.x());
        EXPECT_NEAR(std::sin(found.angles[face] - expected), 0.0, 1e-9);
    }
    ASSERT_EQ(found.points.size(), 1U);
    EXPECT_EQ(found.points[0].order, 1);
}

TEST(Page, ATextureIsAnImageInThePage) {
    const Mesh mesh = bumpy_square(2);
    PageContent content = content_of(mesh, {flat_map(mesh)});
    EXPECT_EQ(data_of(render_page(content))["texture"], false);
    content.texture = two_pixels;
    EXPECT_EQ(
        data_of(render_page(content))["texture"],
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mO4Y6OhEXACAAjbAoHFefA2AAAAAElF"
        "TkSuQmCC");
    content.texture = "\xff\xd8\xff\xe0";
    EXPECT_EQ(data_of(render_page(content))["texture"], "data:image/jpeg;base64,/9j/4A==");
    content.texture = "<svg>";
    EXPECT_EQ(test::cause_of([&] { render_page(content); }), Cause::bad_option);
}

TEST(Page, RefusesWhatDoesNotFit) {
    const Mesh mesh = bumpy_square(3);
    const auto cause_of = [](const PageContent& content) { return test::cause_of([&] { render_page(content); }); };
    EXPECT_EQ(cause_of(content_of(mesh, {})), Cause::bad_option);
    PageMap few = flat_map(mesh);
    few.abs_mu.conservativeResize(3);
    EXPECT_EQ(cause_of(content_of(mesh, {few})), Cause::bad_option);
    PageMap short_map = flat_map(mesh);
    short_map.map.conservativeResize(5, 2);
    EXPECT_EQ(cause_of(content_of(mesh, {short_map})), Cause::bad_option);
    for (const char* record : {"", "[1]", "{\"a\":", "{\"a\":NaN}"}) {
        PageContent content = content_of(mesh, {flat_map(mesh)});
        content.record_json = record;
        EXPECT_EQ(cause_of(content), Cause::bad_option) << record;
    }
}

TEST(Drawing, SplitsAQuadAlongItsShorterDiagonal) {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0.0, 0.0, 2.0, 0.0, 2.5, 1.0, 0.5, 0.3;  // 1–3 is shorter than 0–2
    mesh.faces.add({0, 1, 2, 3});
    const Drawing drawing = make_drawing(mesh, 10);
    ASSERT_EQ(drawing.triangles.size(), 2U);
    EXPECT_EQ(drawing.triangles[0], (std::array<int, 3>{1, 2, 3}));
    EXPECT_EQ(drawing.triangles[1], (std::array<int, 3>{1, 3, 0}));
}

TEST(Drawing, CoarseVerticesAreMeans) {
    const Mesh mesh = bumpy_square(40);
    const Drawing drawing = make_drawing(mesh, 500);
    ASSERT_TRUE(drawing.coarsened());
    Positions values = mesh.positions;
    values.row(0).setConstant(nan);
    const Positions reduced = drawing.reduce(values);
    ASSERT_EQ(reduced.rows(), drawing.vertex_count);
    EXPECT_TRUE(reduced.allFinite());
    for (const auto& triangle : drawing.triangles) {
        const auto point = [&](int i) { return Eigen::Vector3d(reduced.row(triangle[static_cast<std::size_t>(i)])); };
        EXPECT_LT((point(1) - point(0)).norm(), 0.6);
    }
}

/// A square whose left and right sides are one line on the surface, as copies, and a picture of it in the plane.
PageContent cut_content(const Mesh& square) {
    PageContent content =
        content_of(square, {{"registration", square.positions, Eigen::VectorXd::Constant(square.face_count(), 0.3)}});
    const int n = static_cast<int>(std::lround(std::sqrt(square.vertex_count()))) - 1;
    for (int v = 0; v < square.vertex_count(); ++v) content.joined.push_back(v % (n + 1) == n ? v - n : v);
    PageMap polygon{"fundamental polygon", square.positions.leftCols(2), {}};
    polygon.of_source = true;
    polygon.outline.emplace_back(2, 2);
    polygon.outline[0] << 1e6 - 2, -2, 1e6 + 2, 2;
    content.maps.push_back(std::move(polygon));
    return content;
}

TEST(Page, ASourceThatIsCutOpenHasCopiesAndAPictureWithAnOutline) {
    const Mesh square = bumpy_square(4);
    const PageContent content = cut_content(square);
    const Json data = data_of(render_page(content));
    const std::vector<std::uint32_t> joined = decode_words(data["joined"]);
    ASSERT_EQ(joined.size(), 25U);
    for (std::uint32_t v = 0; v < 25; ++v) EXPECT_EQ(joined[v], v % 5 == 4 ? v - 4 : v);
    const Json& picture = data["maps"][1];
    EXPECT_TRUE(picture["of_source"].get<bool>());
    EXPECT_FALSE(picture.contains("abs_mu"));
    EXPECT_EQ(decode_floats(picture["outline"][0]), (std::vector<float>{-1, -1, 1, 1}));  // larger than the square
    EXPECT_EQ(decode_floats(picture["coordinates"])[0], -0.5f);

    PageContent alone = content;
    alone.maps.erase(alone.maps.begin());
    EXPECT_EQ(test::cause_of([&] { render_page(alone); }), Cause::bad_option);
    PageContent other = content;
    other.joined.pop_back();
    EXPECT_EQ(test::cause_of([&] { render_page(other); }), Cause::bad_option);
    PageContent coarse = content;
    coarse.drawn_faces = 10;
    const Json coarsened = data_of(render_page(coarse));
    EXPECT_FALSE(coarsened.contains("joined"));
    EXPECT_EQ(coarsened["maps"].size(), 1U);
}

/// For the check in a browser: pages of every kind, written where BELTRAMI_PAGES says.
TEST(Page, WritesPagesForTheBrowserCheck) {
    const char* folder = std::getenv("BELTRAMI_PAGES");
    if (folder == nullptr) GTEST_SKIP() << "BELTRAMI_PAGES is not set";
    const auto write = [&](const std::string& name, const PageContent& content) {
        std::ofstream(std::string(folder) + "/" + name) << render_page(content);
    };
    const Mesh triangles = bumpy_square(30);
    PageMap broken = flat_map(triangles, "</script><b>broken");
    broken.abs_mu.head(3) << nan, infinity, 1.5;
    broken.map.row(40).setConstant(nan);
    write("triangles.html", content_of(triangles, {flat_map(triangles), broken}));
    const Mesh quads = bumpy_square(20, Faces::quads);
    Positions higher = quads.positions;  // a picture of its own, and every overlay another
    higher.col(2) *= 3;
    PageContent space = content_of(quads, {{"space", higher, Eigen::VectorXd::Constant(quads.face_count(), 0.2)}});
    space.record_json = "{}";
    space.history_k.clear();
    space.history_change.clear();
    space.history_largest.clear();
    write("quads_in_space.html", space);
    PageContent coarse = content_of(triangles, {flat_map(triangles)});
    coarse.drawn_faces = 500;
    write("coarsened.html", coarse);
    PageMap with_differential = flat_map(triangles);
    PageDifferential& phi = with_differential.differential.emplace();
    phi.angles = Eigen::VectorXd::Constant(triangles.face_count(), 0.4);
    for (const int order : {1, -1}) {
        const int face = 900 + 50 * order;
        const auto v = triangles.faces[face];
        phi.points.push_back({{face, {v[0], v[1], v[2]}, {0.3, 0.3, 0.4}}, order, false});
    }
    PageContent differential = content_of(triangles, {with_differential});
    differential.texture = two_pixels;
    differential.record_json =
        R"({"surface_flow":{"history":{"energy":[1,0.1,0.01],"l2":[1,0.3,0.1],"squared":[1,0.1,0.01],
        "sup":[1,0.5,0.3],"flips":[0,0,0],"length":[1,1,0.5]}}})";
    write("differential.html", differential);
    PageContent cut = cut_content(triangles);
    PageDifferential& on_cut = cut.maps[0].differential.emplace();
    on_cut.angles = Eigen::VectorXd::Constant(triangles.face_count(), 0.1);
    const auto corner = triangles.faces[900];
    on_cut.points.push_back({{900, {corner[0], corner[1], corner[2]}, {0.3, 0.3, 0.4}}, 2, false});
    write("cut.html", cut);
    const Mesh large = bumpy_square(317);
    write("large.html", content_of(large, {flat_map(large)}));
}

}  // namespace
}  // namespace beltrami
