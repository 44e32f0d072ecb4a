#include <beltrami/differentials/quadratic_differential.h>

#include <algorithm>
#include <array>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/differentials/face_charts.h>
#include <beltrami/differentials/tabulated_space.h>

namespace beltrami {

namespace {

/// One function of a user's own.
class GivenSpace final : public DifferentialSpace {
  public:
    explicit GivenSpace(std::function<Complex(Complex)> phi) : phi_(std::move(phi)) {}

    int size() const override { return 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override {
        Eigen::MatrixXcd values(points.positions.size(), 1);
        parallel_for(0, static_cast<int>(points.positions.size()), [&](int first, int last) {
            for (int i = first; i < last; ++i)
                values(i, 0) = phi_(points.positions[i]) * points.derivatives[i] * points.derivatives[i];
        });
        return values;
    }
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    std::function<Complex(Complex)> phi_;
};

/// The vertices that a chart has at given places exactly, ascending.
std::vector<int> vertices_at(const Chart& chart, std::vector<Complex> places) {
    const auto before = [](Complex a, Complex b) {
        return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
    };
    std::sort(places.begin(), places.end(), before);
    std::vector<int> vertices;
    for (Eigen::Index v = 0; v < chart.vertices.size() && !places.empty(); ++v)
        if (std::binary_search(places.begin(), places.end(), chart.vertices[v], before))
            vertices.push_back(static_cast<int>(v));
    return vertices;
}

/// Corners of its face that a place names.
std::array<int, 3> corners_of(const Surface& source, const MeshPoint& place) {
    const auto corners = source.mesh.faces[place.face];
    std::array<int, 3> result;
    for (int i = 0; i < 3; ++i)
        result[i] = static_cast<int>(std::find(corners.begin(), corners.end(), place.vertices[i]) - corners.begin());
    return result;
}

/// Places in a chart that is known at the corners of faces: inside quads linear, inside triangles as the c-step has it.
ChartPoints points_in_atlas(const Surface& source, const Chart& chart, std::span<const MeshPoint> places,
                            const std::vector<int>& samples) {
    const FaceCharts centred(source, chart);
    const auto count = static_cast<Eigen::Index>(places.size());
    ChartPoints points{Eigen::VectorXcd(count), Eigen::VectorXcd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const MeshPoint& place = places[i];
        const std::array<int, 3> corners = corners_of(source, place);
        if (source.mesh.faces.degree(place.face) == 3) {
            std::array<double, 3> barycentric{};
            for (int j = 0; j < 3; ++j) barycentric[corners[j]] += place.barycentric[j];
            const auto [position, derivative] = centred.at(samples[i], place.face, barycentric);
            points.positions[i] = position;
            points.derivatives[i] = derivative;
            continue;
        }
        points.positions[i] = 0;
        for (int j = 0; j < 3; ++j)
            points.positions[i] +=
                place.barycentric[j] * chart.corners[source.mesh.faces.first_corner(place.face) + corners[j]];
        points.derivatives[i] = chart.derivatives[samples[i]];
    }
    return points;
}

}  // namespace

Eigen::VectorXcd QuadraticDifferential::at_samples(const Surface& source) const {
    if (zero()) return Eigen::VectorXcd::Zero(source.operators.sample_count());
    if (const Eigen::MatrixXcd* values = space->tabulated()) return *values * space->of_generators(coefficients);
    Eigen::VectorXcd values = at({chart->positions, chart->derivatives});
    for (Eigen::Index s = 0; s < values.size(); ++s)
        if (chart->excluded[s]) values[s] = 0;
    return values;
}

Eigen::VectorXcd QuadraticDifferential::at(const ChartPoints& points) const {
    if (zero()) return Eigen::VectorXcd::Zero(points.positions.size());
    return space->combination(points, coefficients);
}

Eigen::VectorXcd QuadraticDifferential::at(const Surface& source, std::span<const MeshPoint> places) const {
    if (zero()) return Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(places.size()));
    if (!tabulated()) return at(chart_points(source, *chart, places));
    const Eigen::VectorXcd values = at_samples(source);
    return values(nearest_samples(source, places));
}

QuadraticDifferential differential_of(std::shared_ptr<const DifferentialSpace> space, const Chart& chart,
                                      Eigen::VectorXcd coefficients, const Singularities& singularities) {
    std::vector<Complex> poles = singularities.pins, jumps;
    for (const auto& held : singularities.held) poles.push_back(held.at);
    for (const auto& curve : singularities.curves)
        jumps.insert(jumps.end(), curve.points.begin() + curve.first, curve.points.begin() + curve.last + 1);
    return {std::move(space), std::make_shared<Chart>(chart), std::move(coefficients),
            vertices_at(chart, std::move(poles)), vertices_at(chart, std::move(jumps))};
}

QuadraticDifferential differential_of(const Surface& source, std::function<Complex(Complex)> phi,
                                      std::vector<int> poles) {
    const Eigen::VectorXcd* z = source.coordinate();
    if (!z)
        throw Error(Cause::bad_mesh, "the source does not lie in the plane in whose coordinates φ is given",
                    "give φ at the samples instead");
    auto chart = std::make_shared<Chart>(make_chart(source, *z, true));
    chart->analytic = [](Complex at) { return std::array<Complex, 2>{at, 1.0}; };
    std::sort(poles.begin(), poles.end());
    return {std::make_shared<GivenSpace>(std::move(phi)),
            std::move(chart),
            Eigen::VectorXcd::Ones(1),
            std::move(poles),
            {}};
}

QuadraticDifferential differential_of(const Surface& source, const Eigen::VectorXcd& values, std::vector<int> poles) {
    if (values.size() != source.operators.sample_count())
        throw Error(Cause::bad_option, "φ has " + std::to_string(values.size()) + " values for " +
                                           std::to_string(source.operators.sample_count()) + " samples");
    std::sort(poles.begin(), poles.end());
    return {std::make_shared<TabulatedSpace>(values, Coefficients::complex),
            std::make_shared<Chart>(chart_of_frames(source)),
            Eigen::VectorXcd::Ones(1),
            std::move(poles),
            {}};
}

std::vector<int> nearest_samples(const Surface& source, std::span<const MeshPoint> places) {
    const Operators& operators = source.operators;
    std::vector<int> first_sample(static_cast<std::size_t>(operators.face_count), -1);
    for (int s = operators.sample_count() - 1; s >= 0; --s) first_sample[operators.faces[s]] = s;
    std::vector<int> samples;
    samples.reserve(places.size());
    for (const MeshPoint& place : places) {
        const auto corners = source.mesh.faces[place.face];
        int sample = first_sample[place.face];
        if (corners.size() == 4) {
            const auto largest = std::max_element(place.barycentric.begin(), place.barycentric.end());
            const int vertex = place.vertices[largest - place.barycentric.begin()];
            sample += static_cast<int>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
        }
        samples.push_back(sample);
    }
    return samples;
}

ChartPoints chart_points(const Surface& source, const Chart& chart, std::span<const MeshPoint> places) {
    const auto count = static_cast<Eigen::Index>(places.size());
    ChartPoints points{Eigen::VectorXcd(count), Eigen::VectorXcd(count)};
    if (const Eigen::VectorXcd* plane = source.coordinate(); plane && chart.exact && chart.analytic) {
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto [position, derivative] = chart.analytic(places[i].interpolate(*plane));
            points.positions[i] = position;
            points.derivatives[i] = derivative;
        }
        return points;
    }
    const std::vector<int> samples = nearest_samples(source, places);
    if (chart.corners.size()) return points_in_atlas(source, chart, places, samples);
    for (Eigen::Index i = 0; i < count; ++i) {
        points.positions[i] = places[i].interpolate(chart.vertices);
        points.derivatives[i] = chart.derivatives[samples[i]];
    }
    return points;
}

}  // namespace beltrami
