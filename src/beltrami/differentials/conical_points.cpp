#include <algorithm>
#include <array>

#include <beltrami/differentials/face_charts.h>
#include <beltrami/differentials/sphere_space.h>

namespace beltrami {

namespace {

using ReferencePlace = std::array<double, 2>;

constexpr int kConicalPoints = 3;
constexpr std::array<double, kConicalPoints> kConicalNodes{0.11270166537925831148, 0.5, 0.88729833462074168852};
constexpr std::array<double, kConicalPoints> kConicalWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// The symmetric rule of degree 4 with six points inside (Dunavant 1985): two kinds of points with two equal weights.
constexpr std::array<std::array<double, 2>, 2> kSymmetric{
    {{0.44594849091596488632, 0.22338158967801146570}, {0.09157621350977074346, 0.10995174365532186764}}};

/// #F 1 for the faces at the landmarks and so many rings around them.
std::vector<char> faces_near(const FaceList& faces, int vertex_count, std::span<const int> landmarks, int rings) {
    std::vector<char> vertex(static_cast<std::size_t>(vertex_count), 0),
        face(static_cast<std::size_t>(faces.size()), 0);
    for (const int v : landmarks) vertex[v] = 1;
    for (int ring = 0; ring <= rings; ++ring) {
        for (int f = 0; f < faces.size(); ++f)
            face[f] = face[f] || std::any_of(faces[f].begin(), faces[f].end(), [&](int v) { return vertex[v] != 0; });
        for (int f = 0; f < faces.size(); ++f)
            if (face[f])
                for (const int v : faces[f]) vertex[v] = 1;
    }
    return face;
}

/// The conical rule on a triangle in the coordinates of a face, its apex first.
void add_rule(const std::array<ReferencePlace, 3>& triangle, double part, std::vector<ReferencePlace>& places,
              std::vector<double>& weights) {
    for (int i = 0; i < kConicalPoints; ++i)
        for (int j = 0; j < kConicalPoints; ++j) {
            const std::array<double, 3> corner{1 - kConicalNodes[i], kConicalNodes[i] * (1 - kConicalNodes[j]),
                                               kConicalNodes[i] * kConicalNodes[j]};
            ReferencePlace place{0, 0};
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 2; ++d) place[d] += corner[c] * triangle[c][d];
            places.push_back(place);
            weights.push_back(2 * part * kConicalNodes[i] * kConicalWeights[i] * kConicalWeights[j]);
        }
}

/// … and the one of degree 2 with three.
constexpr double kThird = 1.0 / 6;

void add_small_rule(std::vector<ReferencePlace>& places, std::vector<double>& weights) {
    for (const ReferencePlace& place : {ReferencePlace{kThird, kThird}, ReferencePlace{1 - 2 * kThird, kThird},
                                        ReferencePlace{kThird, 1 - 2 * kThird}}) {
        places.push_back(place);
        weights.push_back(1.0 / 3);
    }
}

void add_symmetric_rule(std::vector<ReferencePlace>& places, std::vector<double>& weights) {
    for (const auto& [side, weight] : kSymmetric)
        for (const ReferencePlace& place :
             {ReferencePlace{side, side}, ReferencePlace{1 - 2 * side, side}, ReferencePlace{side, 1 - 2 * side}}) {
            places.push_back(place);
            weights.push_back(weight);
        }
}

/// A sample's part of its face as triangles with the apex first: the whole triangle, or the quarter of a quad at its
/// corner q, halved from there.
std::vector<std::array<ReferencePlace, 3>> triangles_of(std::size_t degree, int q, int apex) {
    constexpr std::array<ReferencePlace, 3> whole{{{0, 0}, {1, 0}, {0, 1}}};
    if (degree == 3) return {{whole[apex], whole[(apex + 1) % 3], whole[(apex + 2) % 3]}};
    constexpr std::array<ReferencePlace, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const auto middle = [&](int a, int b) {
        return ReferencePlace{0.5 * (square[a][0] + square[b][0]), 0.5 * (square[a][1] + square[b][1])};
    };
    const ReferencePlace corner = square[q], next = middle(q, (q + 1) % 4), centre{0.5, 0.5},
                         last = middle(q, (q + 3) % 4);
    return {{corner, next, centre}, {corner, centre, last}};
}

Complex position(const Chart& chart, int first_corner, std::size_t degree, const ReferencePlace& place) {
    const auto at = [&](int j) { return chart.corners[first_corner + j]; };
    const auto [x, y] = place;
    if (degree == 3) return at(0) + x * (at(1) - at(0)) + y * (at(2) - at(0));
    return (1 - x) * (1 - y) * at(0) + x * (1 - y) * at(1) + x * y * at(2) + (1 - x) * y * at(3);
}

}  // namespace

SamplePoints conical_points(const Surface& source, const Chart& chart, std::span<const int> landmarks, int rings) {
    const Operators& operators = source.operators;
    const FaceList& faces = source.mesh.faces;
    const std::vector<char> near = faces_near(faces, source.mesh.vertex_count(), landmarks, rings);
    const FaceCharts centred(source, chart);
    SamplePoints result;
    std::vector<Complex> positions, derivatives;
    std::vector<double> all_weights;
    for (int s = 0, q = 0; s < operators.sample_count(); ++s) {
        const int face = operators.faces[s];
        q = s > 0 && face == operators.faces[s - 1] ? q + 1 : 0;
        const auto corners = faces[face];
        if (!near[face] && corners.size() != 3) continue;
        const auto pole = std::find_if(corners.begin(), corners.end(), [&](int v) {
            return std::find(landmarks.begin(), landmarks.end(), v) != landmarks.end();
        });
        const int apex = pole == corners.end() ? 0 : static_cast<int>(pole - corners.begin());
        std::vector<ReferencePlace> places;
        std::vector<double> weights;
        if (!near[face]) {
            add_small_rule(places, weights);
        } else if (corners.size() == 3 && pole == corners.end()) {
            add_symmetric_rule(places, weights);
        } else {
            const auto triangles = triangles_of(corners.size(), q, apex);
            for (const auto& triangle : triangles)
                add_rule(triangle, 1.0 / static_cast<double>(triangles.size()), places, weights);
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            result.samples.push_back(s);
            if (corners.size() == 3) {
                const auto [place, derivative] =
                    centred.at(s, face, {1 - places[i][0] - places[i][1], places[i][0], places[i][1]});
                positions.push_back(place);
                derivatives.push_back(derivative);
            } else {
                positions.push_back(position(chart, faces.first_corner(face), corners.size(), places[i]));
                derivatives.push_back(chart.derivatives[s]);
            }
            all_weights.push_back(weights[i]);
        }
    }
    const auto count = static_cast<Eigen::Index>(positions.size());
    result.points.positions = Eigen::Map<const Eigen::VectorXcd>(positions.data(), count);
    result.points.derivatives = Eigen::Map<const Eigen::VectorXcd>(derivatives.data(), count);
    result.weights = Eigen::Map<const Eigen::VectorXd>(all_weights.data(), count);
    return result;
}

}  // namespace beltrami
