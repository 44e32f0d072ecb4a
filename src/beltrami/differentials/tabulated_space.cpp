#include <beltrami/differentials/tabulated_space.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <beltrami/base/error.h>

namespace beltrami {

TabulatedSpace::TabulatedSpace(Eigen::MatrixXcd values, Coefficients coefficients)
    : values_(std::move(values)), coefficients_(coefficients) {
    std::vector<int> samples;
    for (Eigen::Index s = 0; s < values_.rows(); ++s)
        if (!values_.row(s).allFinite()) samples.push_back(static_cast<int>(s));
    if (samples.empty()) return;
    const std::string where =
        std::to_string(samples.size()) + " samples, the first of which is " + std::to_string(samples.front());
    throw Error(Cause::bad_option, "tabulated differentials are not finite at " + where, "give finite values",
                {Things::samples, std::move(samples)});
}

Eigen::MatrixXcd TabulatedSpace::generators(const ChartPoints&) const {
    throw std::logic_error("TabulatedSpace: nothing is known between the samples");
}

Chart chart_of_frames(const Surface& source) {
    const int samples = source.operators.sample_count();
    Chart chart;
    chart.derivatives = Eigen::VectorXcd::Constant(samples, std::sqrt(std::numbers::pi / source.operators.area()));
    chart.excluded.assign(samples, 0);
    return chart;
}

}  // namespace beltrami
