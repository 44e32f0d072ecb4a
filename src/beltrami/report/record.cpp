#include <beltrami/report/record.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <beltrami/report/text_table.h>

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

Json to_object(const FlowRecord& flow) {
    Json object = {{"coefficient", flow.coefficient}};
    if (flow.target) object["target"] = *flow.target;
    object["error"] = {{"l2", number(flow.error.l2)},
                       {"sup", number(flow.error.sup)},
                       {"residual", number(flow.error.residual)},
                       {"misfit", number(flow.error.misfit)}};
    object["fits"] = flow.fits;
    if (flow.target) object["loops"] = to_rows(flow.loops);
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
    return {{"shapes", distances.shapes},
            {"distance", to_rows(distances.matrix.distance)},
            {"lower", to_rows(distances.matrix.lower)},
            {"upper", to_rows(distances.matrix.upper)},
            {"merges", std::move(merges)}};
}

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

std::string cell(const std::optional<double>& value, int digits) {
    if (!value) return "";
    if (std::isnan(*value)) return "-";
    return std::isinf(*value) ? "inf" : fmt::format("{:.{}f}", *value, digits);
}

}  // namespace

SourceRecord source_record(const Mesh& mesh) {
    return {mesh.vertex_count(), mesh.face_count(), {}};
}

SourceRecord source_record(const Mesh& mesh, const Topology& topology) {
    SourceRecord record = source_record(mesh);
    record.shape = {topology.components, topology.genus, {}};
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l) {
        const std::vector<int>& loop = topology.boundary_loops[l];
        record.shape->boundary_loops.push_back({topology.loop_lengths[l], static_cast<int>(loop.size()), loop[0]});
    }
    return record;
}

SourceRecord source_record(const Surface& surface) {
    return source_record(surface.mesh, surface.topology);
}

MapRecord map_record(const Distortion& distortion) {
    MapRecord record;
    record.mean = distortion.mean;
    record.standard_deviation = distortion.standard_deviation;
    record.p99 = distortion.p99;
    record.max = distortion.max;
    record.flipped = static_cast<int>(distortion.flipped.size());
    record.degenerate = static_cast<int>(distortion.degenerate.size());
    if (distortion.flipped.empty()) record.K_max = distortion.max_dilatation();
    return record;
}

namespace {

/// Of either kind of extremal map: with the boundary prescribed, or sliding.
}  // namespace

MapRecord map_record(const ExtremalMap& result) {
    MapRecord record = map_record(result.distortion);
    record.k = result.k;
    record.K = result.K;
    if (result.distortion.flipped.empty() || result.K_lower > 1) record.K_lower = result.K_lower;
    record.K_lower_proved = result.K_lower_proved;
    for (const Bound& bound : result.bounds)
        if (bound.kind == Bound::Kind::verified) record.K_upper = bound.K;
    record.bounds = result.bounds;
    record.boundary_residual = result.boundary_residual;
    return record;
}

namespace {

bool is_estimate(Bound::Kind kind) {
    return kind == Bound::Kind::reich_strebel_estimate || kind == Bound::Kind::averaged_estimate;
}

}  // namespace

MapRecord map_record(const LeastMaximumMap& result) {
    MapRecord record = map_record(result.distortion);
    if (result.extremal) {
        // k, K and the attained value are those of another map; what is below K* is below every map's K.
        for (const Bound& bound : result.extremal->bounds)
            if (bound.kind != Bound::Kind::attained && !is_estimate(bound.kind)) record.bounds.push_back(bound);
        if (result.extremal->distortion.flipped.empty() || result.extremal->K_lower > 1)
            record.K_lower = result.extremal->K_lower;
        record.K_lower_proved = result.extremal->K_lower_proved;
        record.boundary_residual = result.extremal->boundary_residual;
    }
    if (record.K_max && std::isfinite(*record.K_max))
        record.bounds.push_back({Bound::Kind::attained, *record.K_max, Bound::Of::extremal, true});
    return record;
}

SolveRecord solve_record(const ExtremalMap& result, double seconds_total) {
    return {result.iterations,
            to_string(result.termination),
            result.factorizations,
            seconds_total,
            {},
            result.folds_removed,
            result.history};
}

OntoRecord onto_record(const ExtremalMap& result, const std::string& target) {
    return {target,
            result.space,
            result.dimension,
            result.expected_dimension,
            result.dimension_gap,
            result.K_upper,
            result.loops,
            result.move,
            result.path,
            result.led,
            result.start_flips};
}

CorrespondenceRecord correspondence_record(const ExtremalMapBetween& result, const std::string& target,
                                           std::size_t pairs) {
    return {target, static_cast<int>(pairs), result.target.correspondence.partner};
}

UniformizationRecord uniformization_record(const Uniformization& result) {
    return {result.chart.outer_loop(), result.holes, result.moduli, result.module, result.chart.roundness};
}

SphereRecord sphere_record(const SphereMap& result) {
    return {
        result.method,         result.route,        result.moved,           result.ideal_vertex,
        result.residual,       result.layout_error, result.centre_distance, static_cast<int>(result.unresolved.size()),
        result.unresolved_area};
}

SolveRecord solve_record(const LeastMaximumMap& result, double seconds_total) {
    // Where rounding allows no better map, it has converged.
    const bool settled = result.fold_free && result.status != FoldFreeStatus::iteration_limit;
    const int first = result.extremal ? result.extremal->iterations : 0;
    return {first + result.iterations,
            to_string(settled ? Termination::converged : Termination::iteration_limit),
            result.factorizations,
            seconds_total,
            {},
            false};
}

CertificateRecord certificate_record(const Certification& certified, double wanted) {
    return {wanted,
            certified.result.K_lower_proved,
            certified.K_upper,
            certified.gap,
            certified.estimated_gap,
            certified.reached,
            certified.refinements,
            certified.proof_triangles,
            certified.reason};
}

CornersRecord corners_record(const ExtremalMap& result) {
    return {static_cast<int>(result.corners.size()), result.sharpest};
}

SplitRecord split_record(const SplitProblem& split, int source_vertices) {
    SplitRecord record{split.split_edges, {}};
    for (std::size_t i = 0; i < split.parents.size(); ++i) {
        std::vector<int> row{source_vertices + static_cast<int>(i)};
        for (const int parent : split.parents[i])
            if (parent >= 0) row.push_back(parent);
        record.added.push_back(std::move(row));
    }
    return record;
}

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
    if (record.flow) json["flow"] = to_object(*record.flow);
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
        if (onto.dimension > 0)
            text += fmt::format("; bracket of K*: {:.5f} to {:.5f} (estimates)", record.map ? *record.map->K_lower : 1,
                                onto.K_upper);
        text += "\n";
    }
    if (record.uniformization) text += lines_of(*record.uniformization);
    if (record.sphere) text += line_of(*record.sphere);
    if (record.flow)
        text += fmt::format(
            "coefficient: off by {:.3g} (root mean square), {:.3g} at most; relative residual {:.3g}, of it {:.3g} no "
            "error of the mesh\n",
            record.flow->error.l2, record.flow->error.sup, record.flow->error.residual, record.flow->error.misfit);
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
    const char* prescribed = record.onto       ? "loops and marks in this homotopy class"
                             : record.homotopy ? "boundary values in this homotopy class"
                                               : "boundary values";
    return fmt::format(
        "no map with these {} stretches less than K = {:.3f} ({})\n"
        "this one: about {:.3f}, at most {:.3f} on 99 % of the area\n",
        prescribed, std::floor(*map.K_lower * 1e3) / 1e3, proved, dilatation(map.mean),
        std::ceil(dilatation(map.p99) * 1e3) / 1e3);
}

}  // namespace beltrami
