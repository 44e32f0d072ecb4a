#include <beltrami/solve/map_result.h>

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
        case Termination::unconfirmed:
            return "unconfirmed";
    }
    return "unknown";
}

void warn_of_folds_and_limit(const std::string& stopped, MapResult& result, const char* further) {
    if (const std::vector<int>& flipped = result.distortion.flipped; !flipped.empty())
        result.warnings.push_back({WarningKind::flipped_faces,
                                   "flipped faces in the result: " + std::to_string(flipped.size()) +
                                       "; it is not one-to-one there" + further,
                                   {Things::faces, flipped}});
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back({WarningKind::iteration_limit, "stopped after " + stopped});
}

}  // namespace beltrami
