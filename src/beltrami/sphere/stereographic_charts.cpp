#include <beltrami/sphere/stereographic_charts.h>

#include <algorithm>
#include <array>
#include <vector>

#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr double kGap = 0.1;  // between the charts

}  // namespace

TextureCoordinates stereographic_charts(const FaceList& faces, const Positions& points) {
    TextureCoordinates texture;
    std::vector<std::array<int, 2>> numbers(static_cast<std::size_t>(points.rows()), {-1, -1});
    std::array<std::vector<int>, 2> vertices;  // of each chart
    std::array<std::vector<int>, 2> corners;   // in the order of the faces: their numbers in the chart, else -1
    for (int f = 0; f < faces.size(); ++f) {
        double height = 0;
        for (const int v : faces[f]) height += points(v, 2);
        const int chart = height >= 0 ? 0 : 1;
        for (const int v : faces[f]) {
            int& number = numbers[v][chart];
            if (number < 0) {
                number = static_cast<int>(vertices[chart].size());
                vertices[chart].push_back(v);
            }
            corners[chart].push_back(number);
            corners[1 - chart].push_back(-1);
        }
    }
    const auto north_count = static_cast<int>(vertices[0].size());
    texture.points.resize(north_count + static_cast<Eigen::Index>(vertices[1].size()), 2);
    double right = 0, left = 0;  // of the first chart, and of the second around its own middle
    for (int chart = 0; chart < 2; ++chart)
        for (std::size_t i = 0; i < vertices[chart].size(); ++i) {
            // Turned over around the x-axis, the south lies in the north and orientation is kept.
            Eigen::Vector3d p = points.row(vertices[chart][i]);
            if (chart == 1) p = {p.x(), -p.y(), -p.z()};
            const Complex z = stereographic(p);
            texture.points.row(chart * north_count + static_cast<Eigen::Index>(i)) << z.real(), z.imag();
            (chart == 0 ? right : left) = chart == 0 ? std::max(right, z.real()) : std::min(left, z.real());
        }
    texture.points.bottomRows(static_cast<Eigen::Index>(vertices[1].size())).col(0).array() += right - left + kGap;
    for (std::size_t c = 0; c < corners[0].size(); ++c)
        texture.corners.push_back(corners[0][c] >= 0 ? corners[0][c] : north_count + corners[1][c]);
    return texture;
}

}  // namespace beltrami
