#include <beltrami/differentials/face_charts.h>

#include <beltrami/sphere/atlas.h>

namespace beltrami {

FaceCharts::FaceCharts(const Surface& source, const Chart& chart)
    : faces_(source.mesh.faces),
      operators_(per_corner(source.operators, source.mesh.faces)),
      places_(chart.corners.size()) {
    middles_.reserve(static_cast<std::size_t>(faces_.size()));
    south_.reserve(static_cast<std::size_t>(faces_.size()));
    for (int f = 0; f < faces_.size(); ++f) {
        const int first = faces_.first_corner(f), degree = faces_.degree(f);
        const Complex mean = chart.corners.segment(first, degree).mean();
        south_.push_back(mean.real() > atlas::kSouth / 2);
        const Complex middle = mean - offset(f);
        middles_.push_back(middle);
        for (int i = first; i < first + degree; ++i) {
            const Complex z = chart.corners[i] - offset(f);
            places_[i] = (z - middle) / (1.0 + std::conj(middle) * z);
        }
    }
}

double FaceCharts::offset(int face) const {
    return south_[face] ? atlas::kSouth : 0.0;
}

std::array<Complex, 2> FaceCharts::at(int sample, int face, const std::array<double, 3>& barycentric) const {
    Complex zeta = 0;
    for (int i = 0; i < 3; ++i) zeta += barycentric[i] * places_[faces_.first_corner(face) + i];
    const Complex middle = middles_[face], rest = 1.0 - std::conj(middle) * zeta;
    const Complex derivative = operators_.derivatives(sample, places_)[0];
    return {offset(face) + (zeta + middle) / rest, derivative * (1 + std::norm(middle)) / (rest * rest)};
}

}  // namespace beltrami
