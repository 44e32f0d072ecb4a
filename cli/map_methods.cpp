#include "map_methods.h"

#include <map>

#include <beltrami/base/error.h>
#include <beltrami/baselines/baseline.h>
#include <beltrami/baselines/t_map_scheme.h>
#include <beltrami/charts/shape.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/teichmuller/certify.h>
#include <beltrami/teichmuller/extremal_between.h>

#include "command.h"
#include "page.h"

namespace beltrami::cli {

namespace {

using Baseline = BaselineMap (*)(const Surface&, const BoundaryCondition&, const BaselineOptions&);

const std::map<std::string, Baseline>& baselines() {
    static const std::map<std::string, Baseline> methods{{"harmonic", harmonic_baseline},
                                                         {"tutte", tutte_baseline},
                                                         {"mean-value", mean_value_baseline},
                                                         {"lscm", lscm_baseline},
                                                         {"arap", arap_baseline},
                                                         {"mips", mips_baseline},
                                                         {"alternation", alternation_baseline},
                                                         {"qc", qc_iteration_baseline}};
    return methods;
}

std::optional<Surface> split_surface(const std::optional<SplitProblem>& split) {
    if (!split) return {};
    return surface_of(split->mesh, split->metric);
}

/// The map and what belongs to it, after the pages.
void take_map(ExtremalMap result, MethodResult& done) {
    done.map = std::move(result.map);
    done.distortion = std::move(result.distortion);
    done.history = std::move(result.history);
    done.differential = std::move(result.differential);
    done.phi = std::move(result.phi);
}

/// An extremal map into the record and the pages.
MethodResult finished(ExtremalMap result, const Surface& source, double start, Record& record) {
    record.solve = solve_record(result, seconds() - start);
    record.map = map_record(result);
    record_findings(result, source.mesh.vertex_count(), record);
    MethodResult done;
    done.split = split_surface(result.split);
    if (result.split) done.face_parents = result.split->face_parents;
    const Surface& used = done.split ? *done.split : source;
    done.pages.push_back({"extremal", positions_of(result.map), result.distortion.face_abs_mu});
    done.pages.push_back(
        {"harmonic", positions_of(result.harmonic), distortion(used.operators, result.harmonic).face_abs_mu});
    take_map(std::move(result), done);
    return done;
}

}  // namespace

void show_differential(const Surface& mapped, MethodResult& result) {
    if (result.phi.size() == 0 || result.differential.zero() || mapped.metric) return;
    result.pages[0].differential = page_differential(mapped, result.phi, result.differential);
}

const std::vector<std::string>& baseline_names() {
    static const std::vector<std::string> names{"harmonic", "tutte", "mean-value",  "lscm",
                                                "arap",     "mips",  "alternation", "qc"};
    return names;
}

MethodResult run_certified(const Surface& source, const Constraints& constraints, ExtremalOptions options, double gap,
                           double start, bool show, Record& record) {
    Certification certified = [&] {
        Progress progress(show);  // gone before anything else is printed
        options.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        return certify(source, constraints, gap, options);
    }();
    record.certificate = certificate_record(certified, gap);
    return finished(std::move(certified.result), source, start, record);
}

MethodResult run_between(const Surface& source, const OntoTarget& target, const Correspondence& wanted,
                         ExtremalOptions options, double start, bool show, Record& record,
                         BoundaryCondition& boundary) {
    ExtremalMapBetween result = [&] {
        Progress progress(show);
        options.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        return extremal_map_between(source, *target.surface(), target.correspondence(), wanted, options);
    }();
    MethodResult done = finished(std::move(result.plane), source, start, record);
    record.correspondence = correspondence_record(result, target.path(), target.correspondence().size());
    done.positions = std::move(result.positions);
    done.places = std::move(result.places);
    boundary = std::move(result.target.boundary);
    return done;
}

namespace {

/// The map of least maximum into the record and the pages.
MethodResult finished(LeastMaximumMap result, double power, const Surface& source, double start, Record& record) {
    record.solve = solve_record(result, seconds() - start);
    record.map = map_record(result);
    record.least_maximum = {power, result.start_max, result.distortion.max};
    if (result.extremal) {
        ExtremalMap start_map = *result.extremal;
        start_map.homotopy = result.homotopy;
        start_map.warnings.clear();  // they speak of the start
        record_findings(start_map, source.mesh.vertex_count(), record);
    } else if (result.split) {
        record.split = split_record(*result.split, source.mesh.vertex_count());
    }
    append(record.warnings, result.warnings);
    MethodResult done;
    done.split = split_surface(result.split);
    if (result.split) done.face_parents = result.split->face_parents;
    done.pages.push_back({"least maximum", positions_of(result.map), result.distortion.face_abs_mu});
    if (result.extremal)
        done.pages.push_back({"extremal", positions_of(result.extremal->map), result.extremal->distortion.face_abs_mu});
    done.map = std::move(result.map);
    done.distortion = std::move(result.distortion);
    return done;
}

}  // namespace

MethodResult run_least_dilatation(const Surface& source, const Constraints& constraints, LeastDilatationOptions options,
                                  double start, bool show, Record& record) {
    LeastDilatationMap result = [&] {
        Progress progress(show);
        options.extremal.progress = options.maximum.extremal.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        options.maximum.progress = [&](int iteration, double energy) {
            progress.show(iteration, energy, "energy");
            return true;
        };
        return least_dilatation_map(source, constraints, options);
    }();
    if (result.extremal) return finished(std::move(*result.extremal), source, start, record);
    return finished(std::move(*result.maximum), options.maximum.power, source, start, record);
}

const std::vector<std::string>& sliding_baseline_names() {
    static const std::vector<std::string> names{"t-map"};
    return names;
}

namespace {

/// Ng, Gu & Lui's scheme, from the start and with the pairs of the extremal map.
void run_t_map(const Surface& source, const TargetDomain& target, const Correspondence& wanted, const Shape& shape,
               std::vector<PageMap>& pages, Record& record) {
    const double start = seconds();
    MethodRecord line;
    line.method = "t-map";
    try {
        FlowStartOptions options;
        options.shapes = {&shape};
        TMapSchemeResult result = t_map_scheme(source, target, {}, wanted, options);
        line.map = map_record(result.distortion);
        line.solve.iterations = result.solves;
        line.solve.termination = to_string(result.termination);
        line.solve.factorizations = result.factorizations;
        for (const Warning& warning : result.warnings) record.warnings.push_back(prefixed("t-map", warning));
        pages.push_back({"t-map", positions_of(result.map), result.distortion.face_abs_mu});
    } catch (const Error& error) {
        record.warnings.push_back(
            {WarningKind::comparison, std::string("t-map is not in the comparison: ") + error.what()});
        return;
    }
    line.solve.seconds_total = seconds() - start;
    record.comparison.push_back(std::move(line));
}

}  // namespace

MethodResult run_onto(const Surface& source, const OntoTarget& target, const Constraints& constraints,
                      ExtremalOptions options, double start, bool show, Record& record,
                      const std::vector<std::string>& compare) {
    MethodResult done;
    const Shape shape(source);
    options.shapes = {&shape};
    ExtremalMap result = [&] {
        Progress progress(show);
        options.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        return extremal_map(source, constraints, options);
    }();
    if (target.surface()) {
        done.positions = std::move(result.positions);
        done.places = std::move(result.places);
    }
    record.solve = solve_record(result, seconds() - start);
    record.map = map_record(result);
    record.onto = onto_record(result, target.path());
    if (result.split) record.split = split_record(*result.split, source.mesh.vertex_count());
    append(record.warnings, result.warnings);
    done.split = split_surface(result.split);
    if (result.split) done.face_parents = result.split->face_parents;
    const Surface& used = done.split ? *done.split : source;
    done.pages.push_back({"extremal", positions_of(result.map), result.distortion.face_abs_mu});
    done.pages.push_back({"start", positions_of(result.start), distortion(used.operators, result.start).face_abs_mu});
    if (!compare.empty()) {
        const std::optional<CircleDomainChart>& circles = result.target_circles;
        Correspondence own = circles
                                 ? correspondence_on_circles(constraints.correspondence, *target.surface(), *circles)
                                 : constraints.correspondence;
        own.loops.clear();
        for (const LoopOnto& loop : result.loops) own.loops.push_back({loop.loop, loop.curve});
        run_t_map(used, circles ? circle_target(*circles) : *target.domain(), own, shape, done.pages, record);
    }
    take_map(std::move(result), done);
    return done;
}

MethodResult run_baseline(const Surface& source, const BoundaryCondition& boundary, const std::string& method,
                          const BaselineOptions& options, double start, MethodRecord& record, Warnings& warnings) {
    BaselineMap result = baselines().at(method)(source, boundary, options);
    record.method = method;
    record.solve.seconds_total = seconds() - start;
    record.solve.iterations = result.iterations;
    record.solve.factorizations = result.factorizations;
    record.solve.termination = to_string(result.converged ? Termination::converged : Termination::iteration_limit);
    MethodResult done;
    done.distortion = distortion(source.operators, result.map);
    record.map = map_record(done.distortion);
    for (const Warning& warning : result.warnings) warnings.push_back(prefixed(method, warning));
    done.pages.push_back({method, positions_of(result.map), done.distortion.face_abs_mu});
    done.map = std::move(result.map);
    return done;
}

}  // namespace beltrami::cli
