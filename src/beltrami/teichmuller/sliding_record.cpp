#include <beltrami/teichmuller/sliding_record.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

double phase_of(const CircleDomainChart& domain, const Surface& source) {
    for (const RoundHole& hole : domain.holes)
        if (std::abs(hole.centre) > 1e-3) return std::arg(hole.centre);
    return std::arg(domain.chart.vertices[source.topology.boundary_loops[domain.outer_loop()][0]]);
}

void record_sliding_bounds(const ReichStrebel& integrals, double k, ExtremalMap& result) {
    result.K_max = largest_dilatation(result.distortion);
    result.K = std::min(integrals.valid ? integrals.estimate : dilatation(k), result.K_max);
    result.k = (result.K - 1) / (result.K + 1);
    if (integrals.valid) {
        result.K_lower = std::max(1.0, integrals.lower);
        result.K_upper = integrals.upper;
        // φ is real along circles, the mesh ends at their chords, and μ is not tangential to them: an error of
        // second order that no quadrature sees.
        result.bounds.push_back({"reich_strebel", result.K_lower, Bound::Of::extremal, false});
        result.bounds.push_back({"reich_strebel_estimate", result.K, Bound::Of::extremal, false});
        result.bounds.push_back({"reich_strebel_upper", result.K_upper, Bound::Of::extremal, false});
    }
    if (std::isfinite(result.K_max)) result.bounds.push_back({"attained", result.K_max, Bound::Of::extremal, true});
}

}  // namespace beltrami
