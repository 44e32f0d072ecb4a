#include <beltrami/targets/target_domain.h>

#include <beltrami/base/error.h>
#include <beltrami/plane/curve_meeting.h>

namespace beltrami {

namespace {

/// @param name of a curve by its index
/// @throw Error with the given cause
template <class Name>
void require_separate(const TargetDomain& domain, Cause cause, const Name& name) {
    const int n = domain.curve_count();
    for (int i = 1; i < n; ++i) {
        for (int j = 0; j < i; ++j)
            if (meeting(domain.curve(j), domain.curve(i)))
                throw Error(cause, name(j) + " and " + name(i) + " meet", "move them apart", {Things::curves, {j, i}});
        if (!domain.outer.contains(domain.curve(i).point(0)))
            throw Error(cause, name(i) + " lies outside " + name(0), "move it inside", {Things::curves, {i}});
    }
    for (int i = 1; i < n; ++i)
        for (int j = 1; j < n; ++j)
            if (j != i && domain.curve(j).contains(domain.curve(i).point(0)))
                throw Error(cause, name(i) + " lies in " + name(j), "give separate holes", {Things::curves, {i, j}});
}

TargetDomain oriented(TargetCurve outer, std::vector<TargetCurve> holes) {
    TargetDomain domain{outer.counter_clockwise() ? std::move(outer) : outer.reversed(), {}};
    for (TargetCurve& hole : holes)
        domain.holes.push_back(hole.counter_clockwise() ? hole.reversed() : std::move(hole));
    return domain;
}

}  // namespace

bool TargetDomain::contains(Complex p) const {
    if (!outer.contains(p)) return false;
    for (const TargetCurve& hole : holes)
        if (hole.contains(p)) return false;
    return true;
}

double TargetDomain::area() const {
    double sum = outer.area();
    for (const TargetCurve& hole : holes) sum -= hole.area();
    return sum;
}

std::string curve_name(int curve) {
    return curve == 0 ? "the outer curve" : "hole " + std::to_string(curve - 1);
}

TargetDomain target_domain(TargetCurve outer, std::vector<TargetCurve> holes) {
    TargetDomain domain = oriented(std::move(outer), std::move(holes));
    require_separate(domain, Cause::bad_option, curve_name);
    return domain;
}

void validate(const TargetDomain& domain) {
    for (int i = 0; i < domain.curve_count(); ++i)
        if (domain.curve(i).counter_clockwise() != (i == 0))
            throw Error(Cause::bad_option, curve_name(i) + " runs the wrong way",
                        "make the domain with target_domain, which turns its curves", {Things::curves, {i}});
    require_separate(domain, Cause::bad_option, curve_name);
}

TargetDomain boundary_domain(const Surface& planar) {
    require_genus_zero(planar);
    const Eigen::VectorXcd* place = planar.coordinate();
    if (!place)
        throw Error(Cause::bad_mesh, "the target mesh does not lie in the plane",
                    "give a mesh with z = 0, or the curves of the target domain");
    const auto name = [](int loop) { return "boundary loop " + std::to_string(loop) + " of the target mesh"; };
    std::vector<TargetCurve> curves;
    for (const std::vector<int>& loop : planar.topology.boundary_loops) {
        std::vector<Complex> corners;
        for (const int vertex : loop) corners.push_back((*place)[vertex]);
        try {
            curves.push_back(TargetCurve::polygon(corners));
        } catch (const Error& error) {
            throw Error(Cause::bad_boundary,
                        name(static_cast<int>(curves.size())) + " is not a simple polygon: " + error.what(), "",
                        error.where());
        }
    }
    const TargetCurve outer = curves[0];
    curves.erase(curves.begin());
    TargetDomain domain = oriented(outer, std::move(curves));
    require_separate(domain, Cause::bad_boundary, name);
    return domain;
}

}  // namespace beltrami
