#include <beltrami/differentials/mixed_domain.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/differentials/gauss_rule.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

/// Length of the panel next to a singular end, as part of the part; each further one reaches this much farther.
constexpr double kFinest = 1e-5, kRatio = 1.8, kShiftedRatio = 1.65;
/// Radians of a power's turn along a panel.
constexpr double kTurnOfPanel = 6, kShiftedTurn = 3.7;
constexpr int kMorePoints = 4;
/// Straight sides: vertices lie on them to this part of the domain, corners are right to so many radians; more sides
/// are no polygon of a few.
constexpr double kStraight = 1e-9, kRight = 1e-6;
constexpr std::size_t kMostSides = 64;

/// Ends of panels on [0, 1].
/// @param longest panel
std::vector<double> panels(bool graded_begin, bool graded_end, double longest, double ratio) {
    // From an end to the middle, then mirrored.
    const auto half = [&](bool graded) {
        std::vector<double> edges{0};
        double at = graded ? kFinest : 0.0;
        if (graded) edges.push_back(at);
        while (at < 0.5) {
            const double next = std::min(graded ? ratio * at : 0.5, at + longest);
            at = next > 0.5 - 0.3 * longest ? 0.5 : next;
            edges.push_back(at);
        }
        return edges;
    };
    std::vector<double> edges = half(graded_begin);
    const std::vector<double> mirrored = half(graded_end);
    for (auto at = mirrored.rbegin() + 1; at != mirrored.rend(); ++at) edges.push_back(1 - *at);
    return edges;
}

}  // namespace

bool MixedDomain::Loop::prescribed() const {
    return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return !part.slides; });
}

bool MixedDomain::closed() const {
    return std::all_of(loops.begin(), loops.end(), [](const Loop& loop) {
        return std::all_of(loop.parts.begin(), loop.parts.end(),
                           [&](const Part& part) { return part.slides == loop.parts[0].slides; });
    });
}

Singularities MixedDomain::singularities() const {
    Singularities result;
    for (std::size_t l = 1; l < loops.size(); ++l) result.holes.push_back({loops[l].centre, loops[l].radius, 1});
    result.pins = pins;
    for (const auto& point : held) result.pins.push_back(point.at);
    for (const Mark& mark : marks) result.pins.push_back(mark.at);
    for (const Loop& loop : loops)
        result.pins.insert(result.pins.end(), loop.transitions.begin(), loop.transitions.end());
    return result;
}

MixedDomain mixed_domain(const Surface& source, const Chart& chart, const std::vector<std::vector<char>>& held,
                         const std::vector<int>& pinned) {
    MixedDomain domain;
    const auto& loops = source.topology.boundary_loops;
    std::vector<int> order{chart.outer_loop};
    for (const Chart::Hole& hole : chart.holes) order.push_back(hole.loop);
    for (std::size_t index = 0; index < order.size(); ++index) {
        MixedDomain::Loop& loop = domain.loops.emplace_back();
        if (index > 0) {
            loop.centre = chart.holes[index - 1].centre;
            loop.radius = chart.holes[index - 1].radius;
        }
        // Counter-clockwise, whichever way the loop runs.
        std::vector<int> vertices = loops[order[index]];
        std::vector<char> is_held = held[order[index]];
        if (index > 0) {
            std::reverse(vertices.begin(), vertices.end());
            std::reverse(is_held.begin(), is_held.end());
        }
        const std::size_t n = vertices.size();
        const auto from_centre = [&](std::size_t i) { return chart.vertices[vertices[i % n]] - loop.centre; };
        const auto first_held =
            static_cast<std::size_t>(std::find(is_held.begin(), is_held.end(), 1) - is_held.begin());
        if (first_held == n) {
            loop.parts.push_back({loop.centre, loop.radius, 0, kTurn, 0, 0, true, false, false});
            continue;
        }
        if (std::count(is_held.begin(), is_held.end(), 1) == static_cast<std::ptrdiff_t>(n)) {
            loop.parts.push_back({loop.centre, loop.radius, 0, kTurn, 0, 0, false, false, false});
            continue;
        }
        // From held vertex to held vertex; neighbours of one condition are joined.
        double angle = std::arg(from_centre(first_held));
        for (std::size_t i = first_held; i < first_held + n;) {
            std::size_t j = i + 1;
            double next = angle + std::arg(from_centre(j) / from_centre(i));
            for (; !is_held[j % n]; ++j) next += std::arg(from_centre(j + 1) / from_centre(j));
            const bool slides = j > i + 1;
            if (!slides && !loop.parts.empty() && !loop.parts.back().slides)
                loop.parts.back().to = next;
            else
                loop.parts.push_back({loop.centre, loop.radius, angle, next, 0, 0, slides, true, true});
            angle = next;
            i = j;
        }
        // The run of prescribed edges that the first held vertex may have cut.
        if (loop.parts.size() > 1 && !loop.parts.front().slides && !loop.parts.back().slides) {
            loop.parts.front().from = loop.parts.back().from - kTurn;
            loop.parts.pop_back();
        }
        for (std::size_t p = 0; p < loop.parts.size(); ++p) {
            const MixedDomain::Part &part = loop.parts[p], &before = loop.parts[p > 0 ? p - 1 : loop.parts.size() - 1];
            const Complex at = loop.centre + std::polar(loop.radius, part.from);
            if (part.slides != before.slides)
                loop.transitions.push_back(at);
            else
                domain.marks.push_back({at, static_cast<int>(index)});
        }
    }
    for (const int v : pinned) domain.pins.push_back(chart.vertices[v]);
    return domain;
}

namespace {

/// The sides of a loop, or nothing where an arc that slides is not one between right angles.
std::optional<std::vector<MixedDomain::Part>> straight_sides(const std::vector<Complex>& z,
                                                             const std::vector<char>& held) {
    const std::size_t n = z.size();
    std::size_t first = 0;  // from the first vertex of a sliding arc
    while (first < n && !(held[first] && !held[(first + 1) % n])) ++first;
    if (first == n) return {};
    const auto slides = [&](std::size_t i) { return !held[i % n] || !held[(i + 1) % n]; };
    std::vector<MixedDomain::Part> sides;
    for (std::size_t i = first; i < first + n; ++i) {
        const Complex from = z[i % n], to = z[(i + 1) % n];
        if (!sides.empty() && sides.back().slides == slides(i)) {
            MixedDomain::Part& last = sides.back();
            const Complex along = (last.end - last.begin) / std::abs(last.end - last.begin);
            const bool on = std::abs(std::imag((to - last.begin) * std::conj(along))) < kStraight;
            if (on && !(slides(i) && held[i % n])) {
                last.end = to;
                continue;
            }
            if (slides(i)) return {};
        }
        sides.push_back({0, 0, 0, 0, from, to, slides(i), false, false});
    }
    if (sides.size() < 2 || sides.size() > kMostSides) return {};
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const MixedDomain::Part &side = sides[i], &next = sides[(i + 1) % sides.size()];
        if (side.slides == next.slides) continue;
        const double turn = std::arg((next.end - next.begin) / (side.end - side.begin));
        if (std::abs(turn - kTurn / 4) > kRight) return {};
    }
    return sides;
}

}  // namespace

std::optional<MixedDomain> straight_domain(const Surface& source, const Chart& chart,
                                           const std::vector<std::vector<char>>& held, const std::vector<int>& pinned) {
    const auto places = [&](int loop) {
        std::vector<Complex> result;
        for (const int v : source.topology.boundary_loops[loop]) result.push_back(chart.vertices[v]);
        return result;
    };
    auto sides = straight_sides(places(chart.outer_loop), held[chart.outer_loop]);
    if (!sides) return {};
    MixedDomain domain;
    domain.loops.push_back({0, 1, std::move(*sides), {}});
    for (const Chart::Hole& hole : chart.holes) {
        const CircleFit fit = fit_circle(places(hole.loop));
        const std::vector<char>& of_loop = held[hole.loop];
        const bool slides = !of_loop[0];
        if (!fit.exact() || std::any_of(of_loop.begin(), of_loop.end(), [&](char h) { return h == slides; })) return {};
        domain.loops.push_back(
            {fit.centre, fit.radius, {{fit.centre, fit.radius, 0, kTurn, 0, 0, slides, false, false}}, {}});
    }
    for (const int v : pinned) domain.pins.push_back(chart.vertices[v]);
    return domain;
}

BoundarySamples boundary_samples(const MixedDomain& domain, int degree, bool shifted) {
    std::vector<Complex> places, tangents;
    std::vector<double> weights;
    BoundarySamples result;
    double whole = 0;
    for (const auto& loop : domain.loops) {
        for (const auto& part : loop.parts) {
            const bool arc = part.radius > 0;
            const double length = arc ? part.to - part.from : std::abs(part.end - part.begin);
            // By the size of the loop: small holes count as much as large ones.
            const double measure = arc ? length / kTurn : length / (kTurn * loop.radius);
            const auto add = [&](double at, double weight) {
                double tame = 1;
                if (part.singular_begin) tame *= at / (at + 0.5);
                if (part.singular_end) tame *= (1 - at) / (1.5 - at);
                const Complex direction = std::polar(1.0, part.from + at * length);
                places.push_back(arc ? part.centre + part.radius * direction
                                     : part.begin + at * (part.end - part.begin));
                const Complex tangent = arc ? kI * direction : (part.end - part.begin) / length;
                tangents.push_back(tangent * tangent);
                weights.push_back(measure * weight * tame);
                result.slides.push_back(part.slides);
            };
            whole += measure;
            const double angle = arc ? length : length / loop.radius;
            if (arc && !part.singular_begin && !part.singular_end && std::abs(length - kTurn) < 1e-9) {
                const int count = shifted ? 6 * (degree + kMorePoints) + 1 : 4 * (degree + kMorePoints);
                for (int i = 0; i < count; ++i) add((i + (shifted ? 0.3 : 0)) / count, 1.0 / count);
                continue;
            }
            const std::vector<double> ends =
                panels(part.singular_begin, part.singular_end,
                       std::min(0.5, (shifted ? kShiftedTurn : kTurnOfPanel) / ((degree + kMorePoints) * angle)),
                       shifted ? kShiftedRatio : kRatio);
            for (std::size_t e = 0; e + 1 < ends.size(); ++e)
                for (const GaussNode& node : kGauss)
                    add(ends[e] + node.place * (ends[e + 1] - ends[e]), node.weight * (ends[e + 1] - ends[e]));
        }
    }
    const auto count = static_cast<Eigen::Index>(places.size());
    result.places = Eigen::Map<const Eigen::VectorXcd>(places.data(), count);
    result.squared_tangents = Eigen::Map<const Eigen::VectorXcd>(tangents.data(), count);
    result.root_weights = (Eigen::Map<const Eigen::VectorXd>(weights.data(), count) / whole).cwiseSqrt();
    return result;
}

}  // namespace beltrami
