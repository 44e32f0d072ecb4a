#include <beltrami/charts/chart.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/parallel.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// A chart with a larger |μ| says nothing about a sample. One face of that kind, at a reflex corner of the source, can
/// hold most of ∫|φ|.
constexpr double kMostDistorted = 0.5;
/// See unseen_part().
constexpr double kWithoutShape = 0.95;

/// Shape functions of the bilinear element at its four Gauss points: corner j at point q.
double bilinear_shape(int q, int j) {
    constexpr double near = 0.62200846792814621559, side = 0.16666666666666666667, far = 0.04465819873852045108;
    const int steps = (q - j + 4) % 4;
    return steps == 0 ? near : steps == 2 ? far : side;
}

bool without_shape(Complex dz, Complex dzbar) {
    return !(std::norm(dzbar) < kWithoutShape * kWithoutShape * std::norm(dz));
}

}  // namespace

Eigen::VectorXcd at_samples(const Operators& operators, const Eigen::VectorXcd& values) {
    Eigen::VectorXcd result(operators.sample_count());
    parallel_for(0, operators.sample_count(), [&](int begin, int end) {
        // A chunk may begin within a face.
        int q = 0;
        while (begin > q && operators.faces[begin - q - 1] == operators.faces[begin]) ++q;
        for (int s = begin; s < end; ++s) {
            if (s > begin) q = operators.faces[s] == operators.faces[s - 1] ? q + 1 : 0;
            const auto stencil = operators.stencil(s);
            Complex sum = 0;
            for (std::size_t j = 0; j < stencil.size(); ++j)
                sum += values[stencil[j]] * (stencil.size() == 3 ? 1.0 / 3 : bilinear_shape(q, static_cast<int>(j)));
            result[s] = sum;
        }
    });
    return result;
}

bool unseen(const Operators& operators, int sample, const Chart& chart) {
    const auto [dz, dzbar] = operators.derivatives(sample, chart.vertices);
    return without_shape(dz, dzbar);
}

double unseen_part(const Surface& source, const Chart& chart) {
    const Eigen::Array2d areas =
        parallel_sum<Eigen::Array2d>(source.operators.sample_count(), Eigen::Array2d::Zero(), [&](int begin, int end) {
            double all = 0, lost = 0;
            for (int s = begin; s < end; ++s) {
                const auto [dz, dzbar] = source.operators.derivatives(s, chart.vertices);
                const double area = source.operators.weights[s] * std::abs(std::norm(dz) - std::norm(dzbar));
                all += area;
                if (without_shape(dz, dzbar)) lost += area;
            }
            return Eigen::Array2d(all, lost);
        });
    return areas[1] / areas[0];
}

namespace {

/// Derivatives, positions at the samples and excluded samples of values that the operators read.
void take_samples(const Operators& operators, const Eigen::VectorXcd& values, Chart& chart) {
    chart.positions = at_samples(operators, values);
    chart.derivatives.resize(operators.sample_count());
    chart.excluded.assign(operators.sample_count(), 0);
    std::vector<int> excluded;
    // A chart that is far from conformal everywhere, of a few long faces, is better than none.
    for (const double limit : {kMostDistorted, kWithoutShape, 1.0}) {
        parallel_for(0, operators.sample_count(), [&](int begin, int end) {
            for (int s = begin; s < end; ++s) {
                const auto [dz, dzbar] = operators.derivatives(s, values);
                chart.derivatives[s] = dz;
                chart.excluded[s] = !(std::norm(dzbar) < limit * limit * std::norm(dz));
            }
        });
        excluded.clear();
        int kept = 0;
        for (int s = 0; s < operators.sample_count(); ++s) {
            kept += !chart.excluded[s];
            if (chart.excluded[s] && (excluded.empty() || operators.faces[s] != excluded.back()))
                excluded.push_back(operators.faces[s]);
        }
        if (kept > 0) break;
    }
    chart.excluded_faces = static_cast<int>(excluded.size());
    if (chart.excluded_faces)
        chart.warnings.push_back(
            {WarningKind::chart,
             "the conformal chart is far from conformal at " +
                 counted(static_cast<std::size_t>(chart.excluded_faces), "face; it is", "faces; they are") +
                 " left out when the quadratic differential is determined",
             {Things::faces, std::move(excluded)}});
}

}  // namespace

Chart make_chart(const Surface& source, Eigen::VectorXcd vertices, bool exact) {
    Chart chart;
    chart.exact = exact;
    chart.vertices = std::move(vertices);
    take_samples(source.operators, chart.vertices, chart);
    return chart;
}

Chart make_atlas(const Surface& source, Eigen::VectorXcd corners) {
    Chart chart;
    chart.corners = std::move(corners);
    take_samples(per_corner(source.operators, source.mesh.faces), chart.corners, chart);
    return chart;
}

}  // namespace beltrami
