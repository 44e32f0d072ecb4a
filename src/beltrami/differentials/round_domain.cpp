#include <beltrami/differentials/round_domain.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

/// Marks lie on their circles, and differ, to this part of the outer radius.
constexpr double kOnCircle = 1e-6;

}  // namespace

int RoundDomain::circle_of(Complex mark) const {
    int nearest = 0;
    double least = INFINITY;
    for (int i = 0; i < circle_count(); ++i) {
        const double distance = std::abs(std::abs(mark - circle(i).centre) - circle(i).radius);
        if (distance < least) least = distance, nearest = i;
    }
    return nearest;
}

Singularities RoundDomain::singularities() const {
    Singularities result;
    for (const Disk& hole : holes) result.holes.push_back({hole.centre, hole.radius, 1});
    result.pins = boundary_marks;
    result.pins.insert(result.pins.end(), interior_marks.begin(), interior_marks.end());
    return result;
}

void RoundDomain::validate() const {
    const auto bad = [](const std::string& sentence, std::vector<int> indices) {
        throw Error(Cause::bad_option, sentence, "give a disk with round holes apart from each other",
                    {Things::curves, std::move(indices)});
    };
    for (int i = 0; i < circle_count(); ++i)
        if (!std::isfinite(std::norm(circle(i).centre)) || !(circle(i).radius > 0) || !std::isfinite(circle(i).radius))
            bad("circle " + std::to_string(i) + " has no radius", {i});
    for (int i = 0; i < static_cast<int>(holes.size()); ++i) {
        if (!(std::abs(holes[i].centre - outer.centre) + holes[i].radius < outer.radius))
            bad("hole " + std::to_string(i) + " does not lie inside the outer circle", {i});
        for (int j = 0; j < i; ++j)
            if (!(std::abs(holes[i].centre - holes[j].centre) > holes[i].radius + holes[j].radius))
                bad("holes " + std::to_string(j) + " and " + std::to_string(i) + " meet", {j, i});
    }
    const double tolerance = kOnCircle * outer.radius;
    for (int i = 0; i < static_cast<int>(boundary_marks.size()); ++i) {
        const Complex p = boundary_marks[i];
        const Disk& on = circle(circle_of(p));
        if (!(std::abs(std::abs(p - on.centre) - on.radius) <= tolerance))
            bad("boundary mark " + std::to_string(i) + " lies on no circle", {i});
        for (int j = 0; j < i; ++j)
            if (!(std::abs(p - boundary_marks[j]) > tolerance))
                bad("boundary marks " + std::to_string(j) + " and " + std::to_string(i) + " coincide", {j, i});
    }
    for (int i = 0; i < static_cast<int>(interior_marks.size()); ++i) {
        const Complex p = interior_marks[i];
        bool inside = std::abs(p - outer.centre) < outer.radius - tolerance;
        for (const Disk& hole : holes) inside = inside && std::abs(p - hole.centre) > hole.radius + tolerance;
        if (!inside) bad("interior mark " + std::to_string(i) + " does not lie inside the domain", {i});
        for (int j = 0; j < i; ++j)
            if (!(std::abs(p - interior_marks[j]) > tolerance))
                bad("interior marks " + std::to_string(j) + " and " + std::to_string(i) + " coincide", {j, i});
    }
}

std::optional<RoundDomain> round_domain(const Surface& source, const Chart& chart, const std::vector<int>& marked,
                                        double tolerance) {
    RoundDomain domain;
    const auto circle_of_loop = [&](int loop) -> std::optional<RoundDomain::Disk> {
        std::vector<Complex> points;
        for (const int v : source.topology.boundary_loops[loop]) points.push_back(chart.vertices[v]);
        const CircleFit fit = fit_circle(points);
        if (!fit.exact(tolerance)) return std::nullopt;
        return RoundDomain::Disk{fit.centre, fit.radius};
    };
    for (int l = 0; l < static_cast<int>(source.topology.boundary_loops.size()); ++l) {
        const std::optional<RoundDomain::Disk> circle = circle_of_loop(l);
        if (!circle) return std::nullopt;
        if (l == chart.outer_loop)
            domain.outer = *circle;
        else
            domain.holes.push_back(*circle);
    }
    for (const int v : marked)
        (source.topology.on_boundary[v] ? domain.boundary_marks : domain.interior_marks).push_back(chart.vertices[v]);
    return domain;
}

}  // namespace beltrami
