#include <beltrami/solve/map_result.h>

#include <limits>

namespace beltrami {

const char* to_string(Termination termination) {
    switch (termination) {
        case Termination::converged:
            return "converged";
        case Termination::iteration_limit:
            return "iteration_limit";
        case Termination::not_teichmuller:
            return "not_teichmuller";
        case Termination::below_bound:
            return "below_bound";
    }
    return "unknown";
}

double largest_dilatation(const Distortion& distortion) {
    return distortion.flipped.empty() ? dilatation(distortion.max) : std::numeric_limits<double>::infinity();
}

}  // namespace beltrami
