#include <beltrami/teichmuller/direct_map.h>

#include <algorithm>
#include <cmath>

#include <beltrami/certificate/attained_dilatation.h>
#include <beltrami/teichmuller/record_proofs.h>

namespace beltrami {

void record_moduli(double lower, double upper, ExtremalMap& result) {
    upper = std::max(lower, upper);  // to rounding
    result.bounds.push_back({Bound::Kind::moduli, lower, Bound::Of::extremal, true});
    result.bounds.push_back({Bound::Kind::moduli_upper, upper, Bound::Of::extremal, true});
    raise_to_proofs(result);
    // I⁺ comes from below; where it has not reached what is proved it says nothing.
    result.K_upper = result.K_upper > lower ? std::min(result.K_upper, upper) : upper;
    result.K_lower = std::min(result.K_lower, upper);
    result.K = std::min(result.K, upper);
    result.k = k_of(result.K);
}

void complete_direct(const Surface& source, const Eigen::VectorXd& u, double least, double most, ExtremalMap& result) {
    const Eigen::VectorXcd values = u.cast<Complex>();
    result.phi.resize(source.operators.sample_count());
    double along = 0;
    for (Eigen::Index s = 0; s < result.phi.size(); ++s) {
        const Complex form = source.operators.derivatives(static_cast<int>(s), values)[0];
        result.phi[s] = form * form;
        along += source.operators.weights[s] * std::real(result.distortion.mu[s] * result.phi[s]);
    }
    if (along < 0) result.phi = -result.phi;
    result.differential = differential_of(source, result.phi);
    result.K_lower = result.K_lower_proved = std::max({1.0, least, 1 / most});
    result.K_upper = std::max(most, 1 / least);
    const AttainedDilatation attained = attained_dilatation(source, result.map, result.distortion);
    result.K_max = attained.K;
    result.K = std::sqrt(result.K_lower * result.K_upper);
    result.k = k_of(result.K);
    result.bounds = {{Bound::Kind::moduli, result.K_lower, Bound::Of::extremal, true},
                     {Bound::Kind::moduli_upper, result.K_upper, Bound::Of::extremal, true},
                     {Bound::Kind::attained, result.K_max, Bound::Of::extremal, attained.rigorous}};
    result.dimension = result.expected_dimension = 1;
    result.space = ExtremalOptions::Space::one_form_squares;
}

}  // namespace beltrami
