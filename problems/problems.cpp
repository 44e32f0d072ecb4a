#include "problems/problems.h"

#include <beltrami/base/error.h>

namespace beltrami::bench {

const std::vector<NamedProblem>& named_problems() {
    static const std::vector<NamedProblem> list{
        {"exact_composition", exact_composition, 0.04},
        {"three_lobes", three_lobes, 0.04},
        {"three_lobes_jittered", three_lobes_jittered, 0.04},
        {"three_lobes_graded", three_lobes_graded, 0.04},
        {"three_lobes_anisotropic", three_lobes_anisotropic, 0.04},
        {"four_points", four_points, 0.04},
        {"bean", bean, 0.04},
        {"half_plane_square", half_plane_square, 0.04},
        {"arrow_head_45", arrow_head_45, 0.02},
        {"arrow_head_65", arrow_head_65, 0.02},
        {"l_to_square", l_to_square, 0.02},
        {"notched_disk", notched_disk, 0.04},
        {"gear_to_disk", gear_to_disk, 0.03},
        {"disk_to_gear", disk_to_gear, 0.02},
        {"wedge", wedge, 0.02},
        {"sector", sector, 0.02},
        {"ring", ring, 0.04},
        {"annulus_stretch", annulus_stretch, 0.08},
        {"annulus_one_turn", annulus_one_turn, 0.08},
        {"annulus_minus_one_turn", annulus_minus_one_turn, 0.08},
        {"annulus_two_turns", annulus_two_turns, 0.05},
        {"moved_hole", moved_hole, 0.03},
        {"ring_to_lobes", ring_to_lobes, 0.03},
        {"doughnut", doughnut, 0.03},
        {"holes_27", holes_27, 0.03},
        {"screw", screw, 0.12},
        {"cad_part", cad_part, 0.05},
        {"curved_plate", curved_plate, 0.06},
        {"pierced_ball", pierced_ball, 0.07},
    };
    return list;
}

Problem named_problem(const std::string& name, double edge_length) {
    for (const NamedProblem& entry : named_problems())
        if (entry.name == name) return entry.make(edge_length > 0 ? edge_length : entry.edge_length);
    std::string names;
    for (const NamedProblem& entry : named_problems()) names += (names.empty() ? "" : ", ") + entry.name;
    throw Error(Cause::bad_option, "there is no problem " + name, "take one of " + names);
}

}  // namespace beltrami::bench
