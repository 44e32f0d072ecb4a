#include <beltrami/teichmuller/onto_quadrilateral.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <beltrami/certificate/modulus.h>
#include <beltrami/teichmuller/direct_map.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Corners of a rectangle and marks at them, to this part of its diagonal.
constexpr double kAtCorner = 1e-9;
/// Of the mean step around it, what a step along a side has at least.
constexpr double kLeastOfNeighbours = 0.1;
constexpr int kAround = 4;

/// The corners of a rectangle where the marks go, in their order; nothing where the curve is no rectangle or they go
/// elsewhere.
std::optional<std::array<Complex, 4>> rectangle_at(const TargetDomain& target,
                                                   const std::array<double, 4>& parameters) {
    if (!target.holes.empty() || target.outer.kind() != TargetCurve::Kind::polygon || target.outer.points().size() != 4)
        return {};
    std::array<Complex, 4> corners;
    for (int i = 0; i < 4; ++i) corners[i] = target.outer.point(parameters[i]);
    const double near = kAtCorner * target.outer.diameter();
    for (const Complex corner : target.outer.points())
        if (std::none_of(corners.begin(), corners.end(), [&](Complex z) { return std::abs(z - corner) < near; }))
            return {};
    const Complex wide = corners[1] - corners[0], high = corners[3] - corners[0];
    if (std::abs(corners[0] + corners[2] - corners[1] - corners[3]) > near ||
        std::abs(std::real(std::conj(wide) * high)) > near * std::abs(high))
        return {};
    return corners;
}

/// Values along a side become ascending from 0 to 1: steps that noise has turned back, and those far below their
/// neighbours, get a part of these.
void make_ascending(const std::vector<int>& side, bool backwards, Eigen::VectorXd& values) {
    const int n = static_cast<int>(side.size()) - 1;
    const auto vertex = [&](int i) { return backwards ? side[n - i] : side[i]; };
    std::vector<double> steps(n);
    for (int i = 0; i < n; ++i) steps[i] = std::max(0.0, values[vertex(i + 1)] - values[vertex(i)]);
    const std::vector<double> given = steps;
    bool changed = false;
    double total = 0;
    for (int i = 0; i < n; ++i) {
        double sum = given[i];
        int count = 1;
        for (int away = 1; away < n && (away <= kAround || !(sum > 0)); ++away)
            for (const int j : {i - away, i + away}) {
                if (j < 0 || j >= n) continue;
                sum += given[j];
                ++count;
            }
        const double least = kLeastOfNeighbours * sum / count;
        changed = changed || steps[i] < least;
        steps[i] = std::max(steps[i], least);
        total += steps[i];
    }
    if (!changed) return;
    double at = 0;
    for (int i = 0; i + 1 < n; ++i) values[vertex(i + 1)] = (at += steps[i] / total);
}

}  // namespace

std::optional<MarkedQuadrilateral> marked_quadrilateral(const Surface& source, const Correspondence& wanted) {
    if (source.topology.boundary_loops.size() != 1 || wanted.marks.size() != 4 || wanted.waypoints) return {};
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    std::array<std::pair<int, double>, 4> marks;
    for (int i = 0; i < 4; ++i) {
        const auto at = std::find(loop.begin(), loop.end(), wanted.marks[i].vertex);
        if (at == loop.end() || !std::holds_alternative<CurveParameter>(wanted.marks[i].to)) return {};
        marks[i] = {static_cast<int>(at - loop.begin()), on_curve(wanted.marks[i]).parameter};
    }
    std::sort(marks.begin(), marks.end());
    MarkedQuadrilateral result{};
    for (int i = 0; i < 4; ++i) std::tie(result.positions[i], result.parameters[i]) = marks[i];
    for (int i = 0; i + 1 < 4; ++i)
        if (result.positions[i] == result.positions[i + 1]) return {};
    return result;
}

std::optional<double> target_modulus(const TargetDomain& target, const std::array<double, 4>& parameters) {
    if (!target.holes.empty()) return {};
    if (target.outer.kind() == TargetCurve::Kind::circle) {
        std::array<double, 4> angles{};
        for (int i = 0; i < 4; ++i)
            angles[i] =
                i == 0 ? parameters[0] / target.outer.radius()
                       : angles[i - 1] + target.outer.ahead(parameters[i - 1], parameters[i]) / target.outer.radius();
        return disk_modulus(angles);
    }
    const auto corners = rectangle_at(target, parameters);
    if (!corners) return {};
    return std::abs((*corners)[1] - (*corners)[0]) / std::abs((*corners)[2] - (*corners)[1]);
}

std::optional<ExtremalMap> quadrilateral_onto_rectangle(const Surface& source, const TargetModel& target,
                                                        const Correspondence& wanted) {
    const auto marked = marked_quadrilateral(source, wanted);
    if (!marked) return {};
    const auto corners = rectangle_at(target.domain(), marked->parameters);
    if (!corners) return {};
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const Sides sides = sides_between(loop, marked->positions);
    QuadrilateralPotentials potentials = quadrilateral_potentials(source.operators, sides);
    make_ascending(sides[0], false, potentials.u);
    make_ascending(sides[2], true, potentials.u);
    make_ascending(sides[1], false, potentials.v);
    make_ascending(sides[3], true, potentials.v);

    const Complex wide = (*corners)[1] - (*corners)[0], high = (*corners)[3] - (*corners)[0];
    ExtremalMap result;
    result.map = ((*corners)[0] + potentials.u.array() * wide + potentials.v.array() * high).matrix();
    result.distortion = distortion(source.operators, result.map);
    result.factorizations = potentials.factorizations;
    if (!result.distortion.flipped.empty()) {
        std::vector<Freedom> freedoms(static_cast<std::size_t>(source.mesh.vertex_count()), Freedom::free);
        for (const int v : loop) freedoms[v] = Freedom::fixed;
        LocalUnfolding opened = unfold_locally(source, freedoms, result.map);
        result.factorizations += opened.factorizations;
        if (!opened.fold_free) return {};
        result.map = std::move(opened.map);
        result.distortion = distortion(source.operators, result.map);
        result.folds_removed = true;
    }
    result.start = result.map;
    const double modulus = std::abs(wide) / std::abs(high);
    complete_direct(source, potentials.u, modulus / potentials.v_energy, modulus * potentials.u_energy, result);
    const TargetCurve& curve = target.domain().outer;
    LoopOnto onto{0, 0, {}, 0};
    double at = curve.nearest(result.map[loop[0]]), twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Complex here = result.map[loop[i]], next = result.map[loop[(i + 1) % loop.size()]];
        onto.parameters.push_back(at);
        at += std::abs(next - here);
        twice += std::imag(std::conj(here - (*corners)[0]) * (next - (*corners)[0]));
    }
    onto.area_ratio = std::abs(0.5 * twice) / curve.area();
    result.loops.push_back(std::move(onto));
    return result;
}

}  // namespace beltrami
