#include <beltrami/uniformize/edge_flips.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// The quadrilateral of an edge i→j that has become l→k, laid out in units of |lk| with l at 0 and k at 1.
struct Quadrilateral {
    Complex i, j, k = 1, l = 0;

    Quadrilateral(const IntrinsicTriangulation& flipped, int h) {
        const int g = flipped.twin(h);
        i = apex(flipped, h, IntrinsicTriangulation::previous(h), IntrinsicTriangulation::next(h));
        j = std::conj(apex(flipped, g, IntrinsicTriangulation::next(g), IntrinsicTriangulation::previous(g)));
    }

  private:
    /// The third corner of the triangle of a half-edge, above the line lk.
    /// @param from_l, from_k the edges that join it with l and with k
    static Complex apex(const IntrinsicTriangulation& flipped, int h, int from_l, int from_k) {
        const double base = flipped.log_length(h);
        const double angle =
            triangle_angles({flipped.log_length(from_k) - base, flipped.log_length(from_l) - base, 0}).angles[0];
        return std::polar(std::exp(flipped.log_length(from_l) - base), angle);
    }
};

/// Weights of a triangle's corners; what rounding leaves outside is put on the border.
std::array<double, 3> weights_in(Complex a, Complex b, Complex c, Complex point) {
    std::array<double, 3> w{std::max(0.0, signed_area(b, c, point)), std::max(0.0, signed_area(c, a, point)),
                            std::max(0.0, signed_area(a, b, point))};
    const double sum = w[0] + w[1] + w[2];
    for (double& weight : w) weight /= sum;
    return w;
}

}  // namespace

void carry_forms(const std::vector<EdgeFlip>& flips, Eigen::MatrixXd& forms) {
    for (const EdgeFlip& flip : flips) {
        // As IntrinsicTriangulation::flip(): h = i→j becomes l→k, and the sides move on by one place.
        const int h = flip.halfedge, g = flip.twin;
        const int h1 = IntrinsicTriangulation::next(h), h2 = IntrinsicTriangulation::previous(h);
        const int g1 = IntrinsicTriangulation::next(g), g2 = IntrinsicTriangulation::previous(g);
        const Eigen::RowVectorXd jk = forms.row(h1), ki = forms.row(h2), il = forms.row(g1), lj = forms.row(g2);
        forms.row(h1) = ki;
        forms.row(h2) = il;
        forms.row(g1) = lj;
        forms.row(g2) = jk;
        forms.row(h) = -(ki + il);
        forms.row(g) = ki + il;
    }
}

std::vector<IntrinsicPoint> before_flips(IntrinsicTriangulation flipped, const std::vector<EdgeFlip>& flips,
                                         std::vector<IntrinsicPoint> points) {
    std::vector<std::vector<int>> inside(static_cast<std::size_t>(flipped.triangle_count()));
    for (std::size_t p = 0; p < points.size(); ++p) inside[points[p].triangle].push_back(static_cast<int>(p));
    for (auto last = flips.rbegin(); last != flips.rend(); ++last) {
        const int h = last->halfedge, g = last->twin;
        std::vector<int> of_h = std::exchange(inside[h / 3], {}), of_g = std::exchange(inside[g / 3], {});
        if (!of_h.empty() || !of_g.empty()) {
            const Quadrilateral q(flipped, h);
            const auto weight = [&](int p, int halfedge) { return points[p].weights[halfedge % 3]; };
            const auto put = [&](int p, Complex place) {
                // i→j again: k on its left, in the triangle of h, and l on its right.
                const bool left = cross(q.j - q.i, place - q.i) >= 0;
                const std::array<double, 3> w =
                    left ? weights_in(q.i, q.j, q.k, place) : weights_in(q.j, q.i, q.l, place);
                const int first = left ? h : g;
                points[p].triangle = first / 3;
                for (int c = 0; c < 3; ++c) points[p].weights[(first % 3 + c) % 3] = w[c];
                inside[first / 3].push_back(p);
            };
            const int h2 = IntrinsicTriangulation::previous(h), g2 = IntrinsicTriangulation::previous(g);
            const int h1 = IntrinsicTriangulation::next(h);
            for (const int p : of_h) put(p, weight(p, h1) * q.k + weight(p, h2) * q.i);  // l is at 0
            for (const int p : of_g) put(p, weight(p, g) * q.k + weight(p, g2) * q.j);
        }
        flipped.undo(*last);
    }
    return points;
}

}  // namespace beltrami
