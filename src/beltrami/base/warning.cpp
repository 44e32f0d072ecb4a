#include <beltrami/base/warning.h>

namespace beltrami {

const char* to_string(WarningKind kind) {
    switch (kind) {
        case WarningKind::file:
            return "file";
        case WarningKind::mesh:
            return "mesh";
        case WarningKind::mended:
            return "mended";
        case WarningKind::edges_split:
            return "edges_split";
        case WarningKind::chart:
            return "chart";
        case WarningKind::pinched_faces:
            return "pinched_faces";
        case WarningKind::differentials:
            return "differentials";
        case WarningKind::constraints:
            return "constraints";
        case WarningKind::pieces:
            return "pieces";
        case WarningKind::start:
            return "start";
        case WarningKind::fallback:
            return "fallback";
        case WarningKind::unfolded:
            return "unfolded";
        case WarningKind::turned_in:
            return "turned_in";
        case WarningKind::unresolved_faces:
            return "unresolved_faces";
        case WarningKind::off_centre:
            return "off_centre";
        case WarningKind::flipped_faces:
            return "flipped_faces";
        case WarningKind::degenerate_faces:
            return "degenerate_faces";
        case WarningKind::branch_points:
            return "branch_points";
        case WarningKind::fold_forced:
            return "fold_forced";
        case WarningKind::iteration_limit:
            return "iteration_limit";
        case WarningKind::corner:
            return "corner";
        case WarningKind::below_bound:
            return "below_bound";
        case WarningKind::rough:
            return "rough";
        case WarningKind::coefficient:
            return "coefficient";
        case WarningKind::free_boundary:
            return "free_boundary";
        case WarningKind::marks:
            return "marks";
        case WarningKind::collapsed_loop:
            return "collapsed_loop";
        case WarningKind::distance:
            return "distance";
        case WarningKind::comparison:
            return "comparison";
        case WarningKind::hint:
            return "hint";
    }
    return "unknown";
}

Warning prefixed(const std::string& name, Warning warning) {
    warning.sentence = name + ": " + warning.sentence;
    return warning;
}

void append(Warnings& warnings, const Warnings& more) {
    warnings.insert(warnings.end(), more.begin(), more.end());
}

std::vector<std::string> sentences(const Warnings& warnings) {
    std::vector<std::string> result;
    result.reserve(warnings.size());
    for (const Warning& warning : warnings) result.push_back(warning.sentence);
    return result;
}

}  // namespace beltrami
