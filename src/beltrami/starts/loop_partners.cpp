#include <beltrami/starts/loop_partners.h>

#include <algorithm>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/circle_matching.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// A moved boundary edge spans less (radians) of its circle.
constexpr double kMostTurn = 2;

/// The curves as wanted.loops has them.
std::vector<int> given_curves(const Correspondence& wanted, int loops) {
    std::vector<char> taken(loops, 0);
    std::vector<int> given(loops, -1);
    for (const auto& [loop, curve] : wanted.loops) {
        if (loop < 0 || loop >= loops || curve < 0 || curve >= loops)
            throw Error(Cause::bad_option, "loops pair " + std::to_string(loop) + ":" + std::to_string(curve) +
                                               ", but there are only loops and curves 0 to " +
                                               std::to_string(loops - 1));
        if (given[loop] >= 0 || taken[curve])
            throw Error(Cause::bad_option,
                        "loops name loop " + std::to_string(loop) + " or curve " + std::to_string(curve) + " twice");
        if ((loop == wanted.outer_loop) != (curve == 0))
            throw Error(Cause::bad_option,
                        "the outer loop " + std::to_string(wanted.outer_loop) + " must go to the outer curve 0",
                        "name another outer loop");
        given[loop] = curve;
        taken[curve] = 1;
    }
    given[wanted.outer_loop] = 0;
    for (int l = 0; l < loops; ++l)
        if (given[l] < 0)
            throw Error(Cause::bad_option, "loops leave out boundary loop " + std::to_string(l),
                        "pair every loop, or none");
    return given;
}

/// Marks as places of the two circle domains; those that validate() is to refuse are passed over.
std::vector<PlacePair> marked_places(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                                     const std::vector<Mark>& marks) {
    std::vector<PlacePair> places;
    for (const Mark& mark : marks) {
        const CurveParameter* place = std::get_if<CurveParameter>(&mark.to);
        if (mark.vertex < 0 || mark.vertex >= source.mesh.vertex_count() || !place || place->curve < 0 ||
            place->curve >= target.domain().curve_count())
            continue;
        const RoundHole circle = target.circle(place->curve);
        places.push_back({chart.chart.vertices[mark.vertex],
                          circle.centre + std::polar(circle.radius, target.angle(place->curve, place->parameter))});
    }
    return places;
}

void move_domain(const CircleDomainChart& chart, const DiskMoebius& move, LoopPartners& result) {
    result.move = move;
    result.vertices = move(chart.chart.vertices);
    result.circles.clear();
    for (std::size_t l = 0; l < result.curves.size(); ++l) {
        const int loop = static_cast<int>(l);
        const RoundHole circle = chart.circle(loop);
        result.circles.push_back(loop == chart.outer_loop() ? circle : move(circle));
    }
}

/// Whether the moved domain is still drawn with its faces: not folded where the chart is not, and no boundary edge so
/// long that the direction around its circle could be lost.
bool is_drawn(const Surface& source, const CircleDomainChart& chart, const LoopPartners& moved) {
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const Complex centre = moved.circles[l].centre;
        const std::size_t n = loops[l].size();
        for (std::size_t i = 0; i < n; ++i)
            if (std::abs(std::arg((moved.vertices[loops[l][(i + 1) % n]] - centre) /
                                  (moved.vertices[loops[l][i]] - centre))) > kMostTurn)
                return false;
    }
    return distortion(source.operators, moved.vertices).flipped.size() <= chart.flipped.size();
}

}  // namespace

LoopPartners loop_partners(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                           const Correspondence& wanted, std::span<const std::array<int, 2>> known) {
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    const int curves = target.domain().curve_count();
    if (loops != curves)
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(loops) + " boundary loops, the target " + std::to_string(curves),
                    "source and target must have the same number of holes");
    LoopPartners result;
    std::vector<PlacePair> places = marked_places(source, chart, target, wanted.marks);
    if (wanted.loops.empty()) {
        CircleMatchingOptions options{.by = wanted.match_by, .places = places};
        for (const auto& [loop, curve] : known)
            for (std::size_t h = 0; h < chart.holes.size(); ++h)
                if (chart.holes[h].loop == loop) options.pairs.push_back({static_cast<int>(h), curve - 1});
        const CircleMatching matching = match_circle_domains(chart.holes, target.holes(), options);
        result.curves.assign(loops, 0);
        for (std::size_t h = 0; h < chart.holes.size(); ++h)
            result.curves[chart.holes[h].loop] = matching.partner[h] + 1;
    } else {
        result.curves = given_curves(wanted, loops);
    }
    if (wanted.waypoints) return turned(result, chart, target, wanted);
    for (const RoundHole& hole : chart.holes)
        places.push_back(
            {hyperbolic_circle(hole).centre, hyperbolic_circle(target.circle(result.curves[hole.loop])).centre});
    move_domain(chart, best_move(places), result);
    return is_drawn(source, chart, result) ? result : turned(result, chart, target, wanted);
}

LoopPartners turned(const LoopPartners& partners, const CircleDomainChart& chart, const TargetModel& target,
                    const Correspondence& wanted) {
    std::vector<PlacePair> centres;
    centres.reserve(chart.holes.size());
    for (const RoundHole& hole : chart.holes)
        centres.push_back({hole.centre, target.circle(partners.curves[hole.loop]).centre});
    LoopPartners result;
    result.curves = partners.curves;
    move_domain(chart, wanted.marks.empty() ? best_rotation(centres) : DiskMoebius(), result);
    return result;
}

}  // namespace beltrami
