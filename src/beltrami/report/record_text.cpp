#include <beltrami/report/record_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/counted.h>
#include <beltrami/report/text_table.h>

namespace beltrami {

namespace {

/// Which holes are turned, in words.
std::string sentence_of(const HomotopyClass& homotopy) {
    std::string turned, unclear;
    for (const HoleTurns& hole : homotopy.holes) {
        if (!hole.meaningful) {
            unclear += fmt::format("{}loop {}", unclear.empty() ? "" : ", ", hole.loop);
        } else if (hole.turns != 0) {
            turned += fmt::format("{}loop {} by {:+}", turned.empty() ? "" : ", ", hole.loop, hole.turns);
        }
    }
    std::string text = "homotopy class: ";
    text += turned.empty() ? "no hole is turned" : "turned is " + turned;
    text += fmt::format(" against loop {}", homotopy.outer_loop);
    if (!unclear.empty()) text += "; it cannot be told of " + unclear + ": faces there are flipped";
    return text + "\n";
}

/// The circles and the moduli.
std::string lines_of(const UniformizationRecord& uniformization) {
    std::string text;
    for (const RoundHole& hole : uniformization.holes)
        text += fmt::format("loop {}: the circle around {:.8f}, {:.8f} of radius {:.8f}\n", hole.loop,
                            hole.centre.real() + 0.0, hole.centre.imag() + 0.0, hole.radius);
    if (uniformization.module) {
        text += fmt::format("conformal module log(1/r)/2pi = {:.8f}\n", *uniformization.module);
    } else if (!uniformization.moduli.empty()) {
        text += "moduli:";
        for (const double value : uniformization.moduli) text += fmt::format(" {:.8f}", value);
        text += "\n";
    } else {
        text += "a disk: no moduli\n";
    }
    return text;
}

/// How the map to the sphere was found.
std::string line_of(const CoefficientError& error) {
    return fmt::format(
        "coefficient: off by {:.3g} (root mean square), {:.3g} at most; relative residual {:.3g}, of it {:.3g} no "
        "error "
        "of the mesh\n",
        error.l2, error.sup, error.residual, error.misfit);
}

std::string line_of(const SphereRecord& sphere) {
    std::string text = "a sphere: no moduli; ";
    switch (sphere.method) {
        case SphereMethod::conformal_equivalence:
            text += fmt::format("conformal equivalence, largest angle defect {:.1e}", sphere.residual);
            break;
        case SphereMethod::least_distortion:
            text += "least mean distortion on this mesh";
            break;
        case SphereMethod::tutte:
            text += "Tutte's map, not conformal";
            break;
    }
    return text + "\n";
}

/// Loops, and what a_i and b_i are made of.
std::string lines_of(const PeriodsRecord& periods) {
    std::string text;
    for (std::size_t l = 0; l < periods.loops.size(); ++l)
        text += fmt::format("loop {}: {} edges, length {:.6g}\n", l, periods.loops[l].vertices.size(),
                            periods.loops[l].length);
    const auto genus = static_cast<int>(periods.periods.rows());
    if (genus == 0) return text;
    for (int c = 0; c < 2 * genus; ++c) {
        text += c < genus ? "a" : "b";
        if (genus > 1) text += std::to_string(c % genus + 1);
        text += " =";
        for (Eigen::Index l = 0; l < periods.basis.rows(); ++l)
            if (const int times = periods.basis(l, c); times != 0) text += fmt::format(" {:+d}*loop {}", times, l);
        text += "\n";
    }
    text += "period matrix:\n";
    for (int i = 0; i < genus; ++i) {
        for (int j = 0; j < genus; ++j)
            text += fmt::format("  {:.8f}{:+.8f}i", periods.periods(i, j).real() + 0.0, periods.periods(i, j).imag());
        text += "\n";
    }
    return text;
}

std::string line_of(const TorusRecord& torus) {
    return fmt::format(
        "a torus: tau = {:.8f}{:+.8f}i (error of this polyhedron's at most {:.1e}); a and b have the lengths {:.6f} "
        "and {:.6f} on the flat torus of area 1\n",
        torus.tau.real() + 0.0, torus.tau.imag(), torus.tau_error, torus.lengths[0], torus.lengths[1]);
}

std::string lines_of(const HyperbolicRecord& hyperbolic) {
    std::string text = fmt::format(
        "a metric of curvature -1, of area {:.6f}: angles are off by {:.1e} at most{}\nlengths of the generators:",
        hyperbolic.area, hyperbolic.residual,
        hyperbolic.boundary.empty() ? fmt::format(", the relation of the generators by {:.1e}", hyperbolic.relation)
                                    : std::string());
    for (const HyperbolicRecord::Generator& generator : hyperbolic.generators)
        text += fmt::format(" {:.6f}", generator.length);
    text += "\n";
    if (hyperbolic.boundary.empty()) return text;
    text += "lengths of the boundary loops, which are closed geodesics:";
    for (const double length : hyperbolic.boundary) text += fmt::format(" {:.6f}", length);
    return text + "\n";
}

/// Where loops go, and what is known of the class.
std::string lines_of(const RegistrationRecord::WithHandles& handles) {
    std::string text = "images of the loops:";
    for (Eigen::Index i = 0; i < handles.homology.rows(); ++i) {
        text += i > 0 ? "; " : " ";
        for (Eigen::Index j = 0; j < handles.homology.cols(); ++j)
            text += fmt::format("{}{}", j > 0 ? " " : "", handles.homology(i, j));
    }
    text += "\n";
    if (handles.mended > 0)
        text += fmt::format("around {} faces nearest points did not close up; edges there follow those farther off\n",
                            handles.mended);
    if (const auto& found = handles.hyperbolic)
        text += fmt::format(
            "weighted by |phi|, |mu| is {:.4f} with a deviation of {:.4f}; energies of harmonic forms ask for "
            "K = {:.5f} (estimate); the straight faces in space have k = {:.4f}\n",
            found->weighted_mean, found->weighted_deviation, found->homology_bound, found->k_in_space);
    if (handles.hyperbolic && handles.hyperbolic->search) {
        const auto& search = *handles.hyperbolic->search;
        text += fmt::format("classes reached from {} starts, by energy (homology asks for K):",
                            search.reached.size() + static_cast<std::size_t>(search.failed));
        for (const auto& r : search.reached) text += fmt::format(" {:.4f} ({:.4f})", r.energy, r.homology_bound);
        text += "\n";
    }
    return text;
}

/// How the map sits in space.
std::string lines_of(const RegistrationRecord& registration) {
    std::string text;
    const auto by_phi = [](double mean, double deviation) {
        return fmt::format("weighted by |phi|, |mu| is {:.4f} with a deviation of {:.4f}\n", mean, deviation);
    };
    if (const auto& sphere = registration.sphere; sphere && sphere->dimension > 0)
        text += by_phi(sphere->weighted_mean, sphere->weighted_deviation);
    if (registration.lp && registration.lp->by_phi)
        text += by_phi((*registration.lp->by_phi)[0], (*registration.lp->by_phi)[1]);
    if (registration.handles) text += lines_of(*registration.handles);
    text += fmt::format("straight faces in space: {} flipped, {} where the mesh does not resolve the map\n",
                        registration.flipped_in_space, registration.unresolved);
    if (registration.lp && registration.lp->curves > 0)
        text += fmt::format("vertices of curves are at most {:.2g} away from their partners\n",
                            registration.lp->curve_distance);
    if (registration.inverse_k) text += fmt::format("the inverse map has k = {:.4f}\n", *registration.inverse_k);
    if (registration.largest_distance)
        text +=
            fmt::format("soft landmarks are at most {:.4g} away from their places\n", *registration.largest_distance);
    return text;
}

std::string lines_of(const RemeshRecord& remesh) {
    const auto angles = [](const char* when, const AngleStatistics& a) {
        return fmt::format("angles {}: smallest {:.1f}, 1 % below {:.1f}, largest {:.1f}; off by {:.1f} on average\n",
                           when, a.smallest, a.one_percent, a.largest, a.mean_deviation);
    };
    std::string text = angles("before", remesh.before) + angles("after", remesh.after);
    text += fmt::format("at most {:.2g} of the diagonal away from the surface; area times {:.4f}; {} opposed to it\n",
                        remesh.distance.largest, remesh.area_ratio,
                        counted(static_cast<std::size_t>(remesh.opposed_after), "face", "faces"));
    text += fmt::format("the valences alone cost |mu| = {:.3f} on average\n", remesh.valence_floor);
    if (remesh.teichmueller)
        text += fmt::format("no map between the two tori has |mu| below {:.4f} everywhere\n", *remesh.teichmueller);
    return text;
}

std::string cell(const std::optional<double>& value, int digits) {
    if (!value) return "";
    if (std::isnan(*value)) return "-";
    return std::isinf(*value) ? "inf" : fmt::format("{:.{}f}", *value, digits);
}

}  // namespace

std::string to_table(const Record& record, const std::string& method) {
    if (!record.map) return {};
    std::vector<std::vector<std::string>> rows{
        {"method", "k", "K", "K_lower", "K_max", "mean", "std", "p99", "max", "flips", "iterations", "seconds"}};
    const auto add = [&](const std::string& name, const MapRecord& map, const SolveRecord* solve) {
        rows.push_back({name, cell(map.k, 4), cell(map.K, 4), cell(map.K_lower, 4), cell(map.K_max, 4),
                        cell(map.mean, 4), cell(map.standard_deviation, 4), cell(map.p99, 4), cell(map.max, 4),
                        std::to_string(map.flipped), solve ? std::to_string(solve->iterations) : "",
                        solve ? fmt::format("{:.3f}", solve->seconds_total) : ""});
    };
    add(method, *record.map, record.solve ? &*record.solve : nullptr);
    for (const MethodRecord& other : record.comparison) add(other.method, other.map, &other.solve);

    return text_table(rows);
}

std::string to_remarks(const Record& record) {
    std::string text;
    if (record.homotopy) text += sentence_of(*record.homotopy);
    if (record.solve && record.solve->folds_removed)
        text += "the iteration left flipped faces; a fold-free solve opened them\n";
    if (record.corners && record.corners->count > 0) {
        const CornersRecord& corners = *record.corners;
        text += fmt::format("source and boundary values have {} {}", corners.count,
                            corners.count == 1 ? "corner" : "corners");
        if (corners.sharpest)
            text += fmt::format("; at vertex {} they force a stretch of about K = {:.3f} (estimate)",
                                corners.sharpest->vertex, corners.sharpest->safe_bound);
        text += "\n";
    }
    if (const auto& slack = record.outline.slack)
        text += fmt::format(
            "boundary points have moved by at most {:.2f} edges along the target (slack {:g}); as they were given K "
            "would be about {:.2f}\n",
            slack->largest_move, slack->slack, slack->K_without);
    if (const auto& noise = record.outline.noise; noise && record.map && record.map->K)
        text += fmt::format(
            "the outline's noise costs: moving points by at most half an edge (slack {:g}) would give K about {:.2f} "
            "instead of {:.2f}\n",
            noise->slack, noise->K, *record.map->K);
    if (record.certificate)
        text += fmt::format("certificate of {:.3g} %: {} ({} {})\n", 100 * record.certificate->wanted,
                            record.certificate->reason, record.certificate->refinements,
                            record.certificate->refinements == 1 ? "refinement" : "refinements");
    if (record.onto) {
        const OntoRecord& onto = *record.onto;
        text += "loops:";
        for (const LoopOnto& loop : onto.loops) text += fmt::format(" {}:{}", loop.loop, loop.curve);
        text += fmt::format("; differentials: dimension {} (theory {})", onto.dimension, onto.expected_dimension);
        const auto is_proved = [&](const MapRecord& map) {
            return map.K_lower_proved && *map.K_lower <= *map.K_lower_proved && map.K_upper &&
                   onto.K_upper >= *map.K_upper;
        };
        if (onto.dimension > 0 && record.map && record.map->K_lower)
            text += fmt::format("; bracket of K*: {:.5f} to {:.5f} ({})", *record.map->K_lower, onto.K_upper,
                                is_proved(*record.map) ? "proved, floating point" : "estimates");
        text += "\n";
    }
    if (record.uniformization) text += lines_of(*record.uniformization);
    if (record.sphere) text += line_of(*record.sphere);
    if (record.periods) text += lines_of(*record.periods);
    if (record.torus) text += line_of(*record.torus);
    if (record.hyperbolic) text += lines_of(*record.hyperbolic);
    if (record.registration) text += lines_of(*record.registration);
    if (record.remesh) text += lines_of(*record.remesh);
    if (const auto& deform = record.deform)
        text += fmt::format(
            "{} for the {} surface only, on whose own vertices |mu| is {:.4f} on average and {:.4f} at most; area "
            "times "
            "{:.3f}\n",
            deform->minimized == "K"     ? "extremal"
            : deform->minimized == "max" ? "of small largest |mu|"
                                         : "of evenly spread |mu|",
            deform->surface, deform->mean_before, deform->max_before, deform->area_ratio);
    if (record.flow) text += line_of(record.flow->error);
    if (record.surface_flow && record.surface_flow->coefficient) text += line_of(record.surface_flow->error);
    if (record.least_maximum)
        text += fmt::format("largest |mu| of a face: {:.4f} before, {:.4f} after\n", record.least_maximum->before,
                            record.least_maximum->after);
    return text;
}

std::string to_sentence(const Record& record) {
    if (!record.map || !record.map->K_lower) return {};
    const MapRecord& map = *record.map;
    const bool rigorous = std::any_of(map.bounds.begin(), map.bounds.end(), [&](const Bound& bound) {
        return bound.proves_from_below() && bound.K == *map.K_lower;
    });
    std::string proved = rigorous ? "proved up to rounding" : "estimate";
    if (!rigorous && map.K_lower_proved && *map.K_lower_proved > 1)
        proved += fmt::format("; proved: K = {:.3f}", std::floor(*map.K_lower_proved * 1e3) / 1e3);
    // Rounded so that what is said stays true.
    const char* prescribed = record.onto ? "loops and marks in this homotopy class"
                             : record.registration && record.registration->handles ? "images of loops"
                             : record.registration ? "places of the landmarks in this homotopy class"
                             : record.homotopy     ? "boundary values in this homotopy class"
                                                   : "boundary values";
    return fmt::format(
        "no map with these {} stretches less than K = {:.3f} ({})\n"
        "this one: about {:.3f}, at most {:.3f} on 99 % of the area\n",
        prescribed, std::floor(*map.K_lower * 1e3) / 1e3, proved, dilatation(map.mean),
        std::ceil(dilatation(map.p99) * 1e3) / 1e3);
}

}  // namespace beltrami
