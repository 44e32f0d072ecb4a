#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami BELTRAMI_PUBLIC {

/// An arc of a boundary loop that slides between two vertices of the loop, which keep their places: those from first on
/// in the order of the loop, to last.
struct SlidingArc {
    int first = 0, last = 0;
    std::optional<TargetCurve> along = {};  ///< nothing: the curve of the loop in the target
};

/// A target that is a surface, in the plane or in space: one component of genus 0.
struct SurfaceTarget {
    const Surface* surface;  ///< kept by reference
    int outer_loop = 0;      ///< the boundary loop to which the source's outer loop goes
};

/// An extremal problem: what is prescribed of the map and what may slide. One of the problems below, or several at
/// once.
///
///     Constraints(boundary)                  all boundary values are prescribed, pins and lines may be inside
///     Constraints(target)                    every boundary loop slides along its curve of the target
///     Constraints(target).pin(vertex, place) … and a vertex inside is pinned
///
/// Conditions mix: with a target, loops of which vertices are prescribed keep those, the rest of them slides; arcs
/// slide between vertices of a loop whatever is prescribed of what is inside them.
struct Constraints {
    BoundaryCondition prescribed;
    /// What loops slide along of which nothing is prescribed. None: nothing slides but arcs.
    std::variant<std::monostate, TargetDomain, SurfaceTarget> target;
    std::vector<SlidingArc> arcs;
    Correspondence correspondence;

    Constraints() = default;
    Constraints(BoundaryCondition boundary) : prescribed(std::move(boundary)) {}
    Constraints(TargetDomain domain, Correspondence how = {})
        : target(std::move(domain)), correspondence(std::move(how)) {}
    Constraints(const Surface& onto, Correspondence how = {}, int outer_loop = 0)
        : target(SurfaceTarget{&onto, outer_loop}), correspondence(std::move(how)) {}
    Constraints(Surface&&, Correspondence = {}, int = 0) = delete;

    Constraints& pin(int vertex, Complex image) {
        prescribed.pin(vertex, image);
        return *this;
    }
    Constraints& line(int vertex, Complex point, Complex direction) {
        prescribed.pin_to_line(vertex, point, direction);
        return *this;
    }
    Constraints& slide(int first, int last, std::optional<TargetCurve> along = {}) {
        arcs.push_back({first, last, std::move(along)});
        return *this;
    }

    const TargetDomain* domain() const { return std::get_if<TargetDomain>(&target); }
    const SurfaceTarget* surface() const { return std::get_if<SurfaceTarget>(&target); }
    /// Whether every loop slides and nothing but marks is prescribed.
    bool all_slides() const {
        return arcs.empty() && prescribed.empty() && !std::holds_alternative<std::monostate>(target);
    }
    /// Whether nothing slides.
    bool all_prescribed() const { return arcs.empty() && std::holds_alternative<std::monostate>(target); }
};

/// @throw Error bad_option: turns or waypoints and a number of loops that do not fit, marks by vertices of a target
/// that
///        has none or on curves of one that is a surface
void validate(const Constraints& constraints, const Surface& source);

}  // namespace beltrami
