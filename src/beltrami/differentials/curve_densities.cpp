#include <beltrami/differentials/curve_densities.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beltrami {

namespace {

constexpr int kMostLevels = 3;
/// Gaps between the first nodes are at most this part of the curve.
constexpr int kGapsAtFirst = 4;
/// Edges between nodes, at least, on curves that are not too short for it: finer ones raised no bound.
constexpr int kFinestGap = 4;

/// (Length of an edge over its distance)² below which the logarithm is a short series, good to 1e-15.
constexpr double kAfar = 0.04;

/// The integrals over one edge a → b, without the factor 1/2πi, of densities that are 1 at one end and 0 at the other.
struct EdgeIntegrals {
    Complex of_start, of_end;
};

EdgeIntegrals edge_integrals(Complex a, Complex b, Complex z) {
    const Complex from_a = a - z, from_b = b - z, edge = b - a;
    // From afar, with q = edge/(middle − z): log((b − z)/(a − z)) = q (1 + q²/12 + q⁴/80 + …).
    const Complex from_middle = 0.5 * (from_a + from_b);
    const double away = std::norm(from_middle);
    if (std::norm(edge) < kAfar * away) {
        const double re = (edge.real() * from_middle.real() + edge.imag() * from_middle.imag()) / away,
                     im = (edge.imag() * from_middle.real() - edge.real() * from_middle.imag()) / away;
        const double s_re = re * re - im * im, s_im = 2 * re * im;  // q²
        double t_re = 1.0 / 53248, t_im = 0;
        for (const double next : {1.0 / 11264, 1.0 / 2304, 1.0 / 448, 1.0 / 80, 1.0 / 12, 0.0}) {
            const double up = t_re * s_re - t_im * s_im + next;
            t_im = t_re * s_im + t_im * s_re;
            t_re = up;
        }
        const Complex half(0.5 * (re + re * t_re - im * t_im), 0.5 * (im + re * t_im + im * t_re)), rest(t_re, t_im);
        return {half + rest, half - rest};
    }
    // (b − z)/(a − z) is real and negative exactly on the edge, where the principal logarithm jumps.
    const Complex ratio = from_b * std::conj(from_a);
    const Complex log(0.5 * std::log(std::norm(from_b) / std::norm(from_a)), std::arg(ratio));
    const Complex place = -from_a * std::conj(edge) / std::norm(edge);
    const Complex of_end = 1.0 + place * log;
    return {log - of_end, of_end};
}

const Complex kFactor = Complex(0, -0.5) * std::numbers::inv_pi;

/// Offsets of nodes from an end: gaps that double, from the finest up to a largest one.
std::vector<int> graded(int reach, int largest_gap) {
    std::vector<int> nodes;
    for (int at = 0, gap = std::min(kFinestGap, largest_gap); at <= reach;
         at += gap, gap = std::min(2 * gap, largest_gap))
        nodes.push_back(at);
    return nodes;
}

}  // namespace

CurveDensities::CurveDensities(const Singularities::Curve& curve) : curve_(curve) {
    const auto& p = curve_.points;
    const int count = static_cast<int>(p.size()), first = curve_.first, last = curve_.last, n = last - first;
    lengths_.assign(count, 0.0);
    for (int i = 1; i < count; ++i) lengths_[i] = lengths_[i - 1] + std::abs(p[i] - p[i - 1]);
    tangents_.assign(count, 1.0);
    for (int i = first; i <= last; ++i) {
        Complex before = i > first ? p[i] - p[i - 1] : Complex(0), after = i < last ? p[i + 1] - p[i] : Complex(0);
        if (curve_.closed && i == first) before = p[last] - p[last - 1];
        if (curve_.closed && i == last) after = p[first + 1] - p[first];
        if (std::abs(before) > 0) before /= std::abs(before);
        if (std::abs(after) > 0) after /= std::abs(after);
        const Complex sum = before + after;
        tangents_[i] = std::abs(sum) > 0 ? sum / std::abs(sum) : after;
    }

    std::vector<int> nodes;
    const int gap = std::max(1, n / kGapsAtFirst);
    if (curve_.closed) {
        for (int i = 0; i < n; i += gap) nodes.push_back(first + i);
        nodes.push_back(last);
    } else {
        for (int i = 0; i < first; ++i) nodes.push_back(i);
        for (const int offset : graded(n / 2, gap)) nodes.push_back(first + offset);
        for (const int offset : graded(n / 2, gap)) nodes.push_back(last - offset);
        for (int i = last + 1; i < count; ++i) nodes.push_back(i);
    }
    std::vector<char> known(count, 0);
    densities_.resize(count, 0);
    first_of_level_.push_back(0);
    for (int level = 0; level < kMostLevels; ++level) {
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        add(nodes, known);
        if (size() == first_of_level_.back()) break;
        first_of_level_.push_back(size());
        const std::vector<int> coarse = nodes;
        for (std::size_t i = 1; i < coarse.size(); ++i)
            if (coarse[i] - coarse[i - 1] >= 2 * kFinestGap) nodes.push_back((coarse[i] + coarse[i - 1]) / 2);
    }
}

/// Appends the hats of nodes that are new.
void CurveDensities::add(const std::vector<int>& nodes, std::vector<char>& known) {
    const int count = static_cast<int>(curve_.points.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int node = nodes[i];
        if (known[node]) continue;
        known[node] = 1;
        if (curve_.closed && node == curve_.last) continue;  // the first one
        const bool real = curve_.real && node >= curve_.first && node <= curve_.last;
        Eigen::VectorXcd hat = Eigen::VectorXcd::Zero(count);
        const auto raise = [&](int peak, int from, int to) {
            for (int j = std::min(from, to); j <= std::max(from, to); ++j) {
                const double height = (lengths_[j] - lengths_[to]) / (lengths_[peak] - lengths_[to]);
                hat[j] = real ? height * std::conj(tangents_[j] * tangents_[j]) : Complex(height);
            }
        };
        hat[node] = real ? std::conj(tangents_[node] * tangents_[node]) : Complex(1);
        if (i > 0) raise(node, node, nodes[i - 1]);
        if (i + 1 < nodes.size()) raise(node, node, nodes[i + 1]);
        if (curve_.closed && node == curve_.first) {
            hat[curve_.last] = hat[node];
            raise(curve_.last, curve_.last, nodes[nodes.size() - 2]);
        }
        densities_.conservativeResize(Eigen::NoChange, densities_.cols() + 1);
        densities_.rightCols(1) = hat;
        real_.push_back(real);
    }
}

Eigen::MatrixXcd CurveDensities::weights(const Eigen::Ref<const Eigen::VectorXcd>& z) const {
    const auto& p = curve_.points;
    Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(z.size(), static_cast<Eigen::Index>(p.size()));
    for (std::size_t i = 1; i < p.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        for (Eigen::Index s = 0; s < z.size(); ++s) {
            const EdgeIntegrals edge = edge_integrals(p[i - 1], p[i], z[s]);
            result(s, column - 1) += kFactor * edge.of_start;
            result(s, column) += kFactor * edge.of_end;
        }
    }
    return result;
}

Eigen::VectorXcd CurveDensities::integral(const Eigen::Ref<const Eigen::VectorXcd>& z,
                                          const Eigen::VectorXcd& density) const {
    const auto& p = curve_.points;
    Eigen::VectorXcd result = Eigen::VectorXcd::Zero(z.size());
    for (std::size_t i = 1; i < p.size(); ++i) {
        const Complex start = density[static_cast<Eigen::Index>(i) - 1], end = density[static_cast<Eigen::Index>(i)];
        if (start == 0.0 && end == 0.0) continue;
        for (Eigen::Index s = 0; s < z.size(); ++s) {
            const EdgeIntegrals edge = edge_integrals(p[i - 1], p[i], z[s]);
            result[s] += start * edge.of_start + end * edge.of_end;
        }
    }
    return kFactor * result;
}

}  // namespace beltrami
