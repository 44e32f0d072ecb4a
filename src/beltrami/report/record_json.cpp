#include <beltrami/report/record_json.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace beltrami {

namespace {

using Json = nlohmann::ordered_json;

/// Places of a warning that a record lists; there may be as many as there are faces.
constexpr std::size_t kMostListed = 100;

/// JSON has no NaN and no infinity: both are null.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void put(Json& object, const char* key, const std::optional<double>& value) {
    if (value) object[key] = number(*value);
}

Json to_object(const MapRecord& map) {
    Json object = Json::object();
    put(object, "k", map.k);
    put(object, "K", map.K);
    put(object, "K_lower", map.K_lower);
    put(object, "K_lower_proved", map.K_lower_proved);
    put(object, "K_upper", map.K_upper);
    put(object, "K_max", map.K_max);
    if (!map.bounds.empty()) {
        Json bounds = Json::array();
        for (const Bound& bound : map.bounds)
            bounds.push_back({{"kind", to_string(bound.kind)},
                              {"K", number(bound.K)},
                              {"of", to_string(bound.of)},
                              {"rigorous", bound.rigorous}});
        object["bounds"] = std::move(bounds);
    }
    object["mu"] = {{"mean", number(map.mean)},
                    {"std", number(map.standard_deviation)},
                    {"p99", number(map.p99)},
                    {"max", number(map.max)}};
    object["flipped"] = map.flipped;
    object["degenerate"] = map.degenerate;
    put(object, "boundary_residual", map.boundary_residual);
    return object;
}

Json to_object(const SolveRecord& solve) {
    Json object = {
        {"iterations", solve.iterations}, {"termination", solve.termination}, {"factorizations", solve.factorizations}};
    object["seconds"] = {{"total", number(solve.seconds_total)}};
    put(object["seconds"], "harmonic", solve.seconds_harmonic);
    if (solve.folds_removed) object["folds_removed"] = true;
    if (!solve.history.empty()) {
        Json k = Json::array(), change = Json::array(), largest = Json::array();
        for (const Iteration& iteration : solve.history) {
            k.push_back(number(iteration.k));
            change.push_back(number(iteration.change));
            largest.push_back(number(iteration.largest));
        }
        object["history"] = {{"k", std::move(k)}, {"change", std::move(change)}, {"largest_mu", std::move(largest)}};
    }
    return object;
}

Json to_object(const HomotopyClass& homotopy) {
    Json holes = Json::array();
    for (const HoleTurns& hole : homotopy.holes)
        holes.push_back({{"loop", hole.loop},
                         {"turns", hole.turns},
                         {"angle", number(hole.angle)},
                         {"outer_vertex", hole.outer_vertex},
                         {"hole_vertex", hole.hole_vertex},
                         {"meaningful", hole.meaningful}});
    return {{"outer_loop", homotopy.outer_loop}, {"holes", std::move(holes)}};
}

Json to_object(const CornersRecord& corners) {
    Json object = {{"count", corners.count}};
    if (corners.sharpest)
        object["sharpest"] = {{"vertex", corners.sharpest->vertex},
                              {"K", number(corners.sharpest->safe_bound)},
                              {"source_angle", number(corners.sharpest->source_angle)},
                              {"image_angle", number(corners.sharpest->image_angle)}};
    return object;
}

Json to_rows(const std::vector<LoopOnto>& loops) {
    Json rows = Json::array();
    for (const LoopOnto& loop : loops)
        rows.push_back({{"loop", loop.loop},
                        {"curve", loop.curve},
                        {"area_ratio", number(loop.area_ratio)},
                        {"parameters", loop.parameters}});
    return rows;
}

Json to_object(const UniformizationRecord& uniformization) {
    Json circles = Json::array();
    for (const RoundHole& hole : uniformization.holes)
        circles.push_back({{"loop", hole.loop},
                           {"centre", {number(hole.centre.real()), number(hole.centre.imag())}},
                           {"radius", number(hole.radius)}});
    Json object = {{"outer_loop", uniformization.outer_loop},
                   {"circles", std::move(circles)},
                   {"moduli", uniformization.moduli},
                   {"roundness", number(uniformization.roundness)}};
    put(object, "module", uniformization.module);
    return object;
}

Json to_object(const SphereRecord& sphere) {
    Json object = {{"method", to_string(sphere.method)}, {"route", to_string(sphere.route)}, {"moved", sphere.moved}};
    if (sphere.ideal_vertex) object["ideal_vertex"] = *sphere.ideal_vertex;
    object["residual"] = number(sphere.residual);
    object["layout_error"] = number(sphere.layout_error);
    object["centre_distance"] = number(sphere.centre_distance);
    object["unresolved"] = {{"faces", sphere.unresolved}, {"area", number(sphere.unresolved_area)}};
    return object;
}

Json pair_of(Complex value) {
    return {number(value.real()), number(value.imag())};
}

Json to_rows(const Eigen::MatrixXi& matrix) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        const Eigen::RowVectorXi row = matrix.row(i);
        rows.push_back(std::vector<int>(row.begin(), row.end()));
    }
    return rows;
}

Json to_object(const PeriodsRecord& periods) {
    Json loops = Json::array(), matrix = Json::array();
    for (const PeriodsRecord::Loop& loop : periods.loops)
        loops.push_back({{"length", number(loop.length)}, {"vertices", loop.vertices}});
    for (Eigen::Index i = 0; i < periods.periods.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index j = 0; j < periods.periods.cols(); ++j) row.push_back(pair_of(periods.periods(i, j)));
        matrix.push_back(std::move(row));
    }
    if (matrix.empty()) return {{"loops", std::move(loops)}};
    return {{"loops", std::move(loops)}, {"basis", to_rows(periods.basis)}, {"matrix", std::move(matrix)}};
}

Json to_object(const TorusRecord& torus) {
    return {{"tau", pair_of(torus.tau)},
            {"tau_error", number(torus.tau_error)},
            {"lengths", {number(torus.lengths[0]), number(torus.lengths[1])}},
            {"flips", torus.flips}};
}

Json to_object(const HyperbolicRecord& hyperbolic) {
    Json generators = Json::array();
    for (const HyperbolicRecord::Generator& generator : hyperbolic.generators) {
        const Eigen::Matrix2d& m = generator.matrix;
        generators.push_back({{"length", number(generator.length)},
                              {"matrix", {{number(m(0, 0)), number(m(0, 1))}, {number(m(1, 0)), number(m(1, 1))}}},
                              {"vertices", generator.vertices}});
    }
    Json object = {{"area", number(hyperbolic.area)},
                   {"residual", number(hyperbolic.residual)},
                   {"flips", hyperbolic.flips},
                   {"ptolemy_flips", hyperbolic.ptolemy_flips},
                   {"inverted", hyperbolic.inverted},
                   {"generators", std::move(generators)},
                   {"relation", number(hyperbolic.relation)}};
    if (!hyperbolic.boundary.empty()) {
        object["boundary"] = Json::array();
        for (const double length : hyperbolic.boundary) object["boundary"].push_back(number(length));
    }
    return object;
}

Json to_object(const RegistrationRecord& registration) {
    Json object = {{"target", registration.target}, {"landmarks", registration.landmarks}};
    if (const auto& sphere = registration.sphere) {
        object["dimension"] = sphere->dimension;
        object["by_phi"] = {{"mean", number(sphere->weighted_mean)}, {"std", number(sphere->weighted_deviation)}};
        object["separation"] = number(sphere->separation);
    }
    if (const auto& lp = registration.lp) {
        object["lp"] = {{"p", lp->p},
                        {"curves", lp->curves},
                        {"start_flipped", lp->start_flipped},
                        {"curve_distance", lp->curve_distance}};
        if (lp->by_phi) object["by_phi"] = {{"mean", number((*lp->by_phi)[0])}, {"std", number((*lp->by_phi)[1])}};
    }
    if (const auto& handles = registration.handles) {
        object["homology"] = to_rows(handles->homology);
        object["mended"] = handles->mended;
        if (const auto& found = handles->hyperbolic) {
            object["dimension"] = found->dimension;
            object["by_phi"] = {{"mean", number(found->weighted_mean)}, {"std", number(found->weighted_deviation)}};
            object["homology_bound"] = number(found->homology_bound);
            object["energy"] = number(found->energy);
            object["k_in_space"] = number(found->k_in_space);
            object["eigenvalues"] = {number(found->eigenvalues[0]), number(found->eigenvalues[1])};
            if (found->search) {
                Json reached = Json::array();
                for (const auto& r : found->search->reached)
                    reached.push_back({{"energy", number(r.energy)},
                                       {"homology_bound", number(r.homology_bound)},
                                       {"twists", r.twists},
                                       {"homology", to_rows(r.homology)}});
                object["search"] = {{"reached", reached}, {"failed", found->search->failed}};
            }
        }
    }
    object["flipped_in_space"] = registration.flipped_in_space;
    object["unresolved"] = registration.unresolved;
    put(object, "inverse_k", registration.inverse_k);
    put(object, "largest_distance", registration.largest_distance);
    return object;
}

Json error_of(const CoefficientError& error) {
    return {{"l2", number(error.l2)},
            {"sup", number(error.sup)},
            {"residual", number(error.residual)},
            {"misfit", number(error.misfit)}};
}

Json to_object(const AngleStatistics& angles) {
    return {{"min", number(angles.smallest)},
            {"p1", number(angles.one_percent)},
            {"max", number(angles.largest)},
            {"median_deviation", number(angles.median_deviation)},
            {"mean_deviation", number(angles.mean_deviation)},
            {"histogram", angles.histogram}};
}

Json to_object(const RemeshRecord& remesh) {
    Json object = {{"reference", remesh.reference}, {"method", remesh.method}};
    if (remesh.power > 0) object["power"] = remesh.power;
    object["angles"] = {{"before", to_object(remesh.before)}, {"after", to_object(remesh.after)}};
    object["distance"] = {{"largest", number(remesh.distance.largest)}, {"mean", number(remesh.distance.mean)}};
    object["area_ratio"] = number(remesh.area_ratio);
    object["size_deviation"] = number(remesh.size_deviation);
    object["opposed"] = {{"before", remesh.opposed_before}, {"after", remesh.opposed_after}};
    object["valence_floor"] = number(remesh.valence_floor);
    put(object, "k_reference", remesh.teichmueller);
    object["steps"] = remesh.steps;
    object["settled"] = remesh.settled;
    return object;
}

Json to_object(const FlowRecord& flow) {
    Json object = {{"coefficient", flow.coefficient}};
    if (flow.target) object["target"] = *flow.target;
    object["error"] = error_of(flow.error);
    object["fits"] = flow.fits;
    if (flow.target) object["loops"] = to_rows(flow.loops);
    return object;
}

/// A column of a history: one number a step.
template <class Member>
Json column(const std::vector<SurfaceFlowIteration>& history, Member&& member) {
    Json values = Json::array();
    for (const SurfaceFlowIteration& step : history) values.push_back(member(step));
    return values;
}

Json to_object(const std::vector<SurfaceFlowIteration>& history) {
    using Step = SurfaceFlowIteration;
    return {{"scheme", column(history, [](const Step& step) { return to_string(step.scheme); })},
            {"energy", column(history, [](const Step& step) { return number(step.energy); })},
            {"length", column(history, [](const Step& step) { return number(step.length); })},
            {"movement", column(history, [](const Step& step) { return number(step.movement); })},
            {"l2", column(history, [](const Step& step) { return number(step.error.l2); })},
            {"squared", column(history, [](const Step& step) { return number(step.squared_error); })},
            {"sup", column(history, [](const Step& step) { return number(step.error.sup); })},
            {"flips", column(history, [](const Step& step) { return step.flips; })}};
}

Json to_object(const SurfaceFlowRecord& flow) {
    Json object = {{"target", flow.target}};
    if (flow.coefficient) object["coefficient"] = *flow.coefficient;
    if (flow.p) object["minimized"] = {{"p", number(*flow.p)}, {"weight", flow.weight}};
    object["start"] = flow.start;
    object["held"] = flow.held;
    object["sliding"] = flow.sliding;
    object["error"] = error_of(flow.error);
    object["fits"] = flow.fits;
    object["history"] = to_object(flow.history);
    return object;
}

Json to_object(const CertificateRecord& certificate) {
    return {{"wanted", number(certificate.wanted)},
            {"proved", certificate.reached},
            {"K_lower_proved", number(certificate.K_lower_proved)},
            {"K_upper", number(certificate.K_upper)},
            {"gap", number(certificate.gap)},
            {"estimated_gap", number(certificate.estimated_gap)},
            {"reached", certificate.reached},
            {"refinements", certificate.refinements},
            {"triangles", certificate.proof_triangles},
            {"reason", certificate.reason}};
}

Json to_object(const OntoRecord& onto) {
    Json object = {{"target", onto.target},
                   {"space", to_string(onto.space)},
                   {"dimension", onto.dimension},
                   {"expected_dimension", onto.expected_dimension},
                   {"gap", number(onto.gap)},
                   {"K_upper", number(onto.K_upper)},
                   {"rotation", number(onto.move.rotation)},
                   {"centre", {number(onto.move.centre.real()), number(onto.move.centre.imag())}},
                   {"led", onto.led},
                   {"start_flips", onto.start_flips}};
    Json path = Json::array();
    for (const Waypoint& waypoint : onto.path)
        path.push_back({waypoint.step, waypoint.loop, waypoint.position.real(), waypoint.position.imag()});
    object["path"] = std::move(path);
    object["loops"] = to_rows(onto.loops);
    return object;
}

Json to_object(const GridRecord& grid) {
    const GridQuality& quality = grid.quality;
    return {{"carried_by", grid.carried_by},
            {"lines", to_string(grid.lines)},
            {"cells", grid.cells},
            {"border", grid.trimmed ? "trimmed" : "stepped"},
            {"pattern", grid.checker ? "checker" : "grid"},
            {"vertices", grid.vertices},
            {"quads", grid.quads},
            {"triangles", grid.triangles},
            {"whole_cells", grid.whole_cells},
            {"trimmed_cells", grid.trimmed_cells},
            {"omitted_cells", grid.omitted_cells},
            {"folded", quality.folded},
            {"area_part", number(grid.area_part)},
            {"quality",
             {{"min_angle", number(quality.min_angle)},
              {"max_angle", number(quality.max_angle)},
              {"mean_skew", number(quality.mean_skew)},
              {"mean_aspect", number(quality.mean_aspect)},
              {"max_aspect", number(quality.max_aspect)},
              {"area_ratio", number(quality.area_ratio)}}}};
}

/// Kinds and places of warnings, in the order of their sentences.
Json to_details(const Warnings& warnings) {
    Json rows = Json::array();
    for (const Warning& warning : warnings) {
        Json row = {{"kind", to_string(warning.kind)}};
        if (const std::vector<int>& indices = warning.where.indices; !indices.empty()) {
            const auto listed = std::min(indices.size(), kMostListed);
            row["of"] = to_string(warning.where.of);
            row["count"] = indices.size();
            row["indices"] = std::vector<int>(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(listed));
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

void add_outline(const OutlineRecord& outline, Json& json) {
    if (const auto& chart = outline.in_chart)
        json["chart"] = {{"mu_mean", number(chart->chart_mean)},
                         {"degree", chart->degree},
                         {"map_mean", number(chart->mean)},
                         {"map_std", number(chart->standard_deviation)}};
    if (const auto& slack = outline.slack)
        json["slack"] = {{"edges", number(slack->slack)},
                         {"largest_move", number(slack->largest_move)},
                         {"energy_before", number(slack->energy_before)},
                         {"energy_after", number(slack->energy_after)},
                         {"K_without", number(slack->K_without)}};
    if (const auto& noise = outline.noise)
        json["noise"] = {
            {"edges", number(noise->slack)}, {"K", number(noise->K)}, {"energy_ratio", number(noise->energy_ratio)}};
}

Json to_rows(const Eigen::MatrixXd& matrix) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(number(matrix(i, j)));
        rows.push_back(std::move(row));
    }
    return rows;
}

Json to_object(const DistancesRecord& distances) {
    Json merges = Json::array();
    for (const Merge& merge : distances.merges)
        merges.push_back({{"clusters", {merge.a, merge.b}}, {"height", number(merge.height)}, {"size", merge.size}});
    Json object = {{"shapes", distances.shapes},
                   {"distance", to_rows(distances.matrix.distance)},
                   {"lower", to_rows(distances.matrix.lower)},
                   {"upper", to_rows(distances.matrix.upper)},
                   {"merges", std::move(merges)}};
    if (distances.tau.empty()) return object;
    Json tau = Json::array(), markings = Json::array();
    for (const Complex value : distances.tau) tau.push_back(pair_of(value));
    for (const TorusDistances::Pair& pair : distances.markings)
        markings.push_back({{"shapes", {pair.from, pair.to}}, {"marking", to_rows(Eigen::MatrixXi(pair.marking))}});
    object["tau"] = std::move(tau);
    object["markings"] = std::move(markings);
    return object;
}

}  // namespace

std::string to_json(const Record& record) {
    Json json;
    json["schema"] = 1;
    json["command"] = record.command;
    Json& source = json["source"];
    source["vertices"] = record.source.vertices;
    source["faces"] = record.source.faces;
    if (record.source.shape) {
        source["components"] = record.source.shape->components;
        Json lengths = Json::array(), loops = Json::array();
        for (const SourceRecord::Loop& loop : record.source.shape->boundary_loops) {
            lengths.push_back(number(loop.length));
            loops.push_back(
                {{"length", number(loop.length)}, {"vertices", loop.vertices}, {"first_vertex", loop.first_vertex}});
        }
        source["boundary_loops"] = std::move(lengths);
        source["loops"] = std::move(loops);
        source["genus"] = record.source.shape->genus;
    }
    if (record.map) json["map"] = to_object(*record.map);
    if (record.solve) json["solve"] = to_object(*record.solve);
    if (record.homotopy) json["homotopy"] = to_object(*record.homotopy);
    if (record.corners) json["corners"] = to_object(*record.corners);
    add_outline(record.outline, json);
    if (record.split) json["split"] = {{"edges", record.split->edges}, {"added", record.split->added}};
    if (record.certificate) json["certificate"] = to_object(*record.certificate);
    if (record.least_maximum)
        json["least_maximum"] = {{"power", record.least_maximum->power},
                                 {"before", number(record.least_maximum->before)},
                                 {"after", number(record.least_maximum->after)}};
    if (record.onto) json["onto"] = to_object(*record.onto);
    if (record.correspondence) {
        Json loops = Json::array();
        for (std::size_t l = 0; l < record.correspondence->partner.size(); ++l)
            loops.push_back({static_cast<int>(l), record.correspondence->partner[l]});
        json["correspondence"] = {{"target", record.correspondence->target},
                                  {"pairs", record.correspondence->pairs},
                                  {"loops", std::move(loops)}};
    }
    if (record.uniformization) json["uniformization"] = to_object(*record.uniformization);
    if (record.sphere) json["sphere"] = to_object(*record.sphere);
    if (record.periods) json["periods"] = to_object(*record.periods);
    if (record.torus) json["torus"] = to_object(*record.torus);
    if (record.hyperbolic) json["hyperbolic"] = to_object(*record.hyperbolic);
    if (record.registration) json["registration"] = to_object(*record.registration);
    if (record.remesh) json["remesh"] = to_object(*record.remesh);
    if (const auto& deform = record.deform)
        json["deform"] = {{"surface", deform->surface},
                          {"minimized", deform->minimized},
                          {"handles", deform->handles},
                          {"surface_mu", {{"mean", number(deform->mean_before)}, {"max", number(deform->max_before)}}},
                          {"area_ratio", number(deform->area_ratio)},
                          {"folds", deform->folds}};
    if (record.flow) json["flow"] = to_object(*record.flow);
    if (record.surface_flow) json["surface_flow"] = to_object(*record.surface_flow);
    if (record.grid) json["grid"] = to_object(*record.grid);
    if (record.distances) json["distances"] = to_object(*record.distances);
    if (!record.comparison.empty()) {
        Json methods = Json::array();
        for (const MethodRecord& other : record.comparison)
            methods.push_back(
                {{"method", other.method}, {"map", to_object(other.map)}, {"solve", to_object(other.solve)}});
        json["comparison"] = std::move(methods);
    }
    if (!record.components.empty()) {
        Json parts = Json::array();
        for (const ComponentRecord& part : record.components)
            parts.push_back({{"first_face", part.first_face},
                             {"faces", part.faces},
                             {"map", to_object(part.map)},
                             {"solve", to_object(part.solve)}});
        json["components"] = std::move(parts);
    }
    json["warnings"] = sentences(record.warnings);
    if (!record.warnings.empty()) json["warning_details"] = to_details(record.warnings);
    // Names of files may hold any bytes; JSON holds UTF-8 only.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace beltrami
