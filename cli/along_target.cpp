#include "along_target.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/registration/natural_start.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/uniformize/sphere_map.h>

#include "parse.h"
#include "space_target.h"

namespace beltrami::cli {

namespace {

constexpr double kLeast = 1e-3;              // of the mean |φ|: zeros of φ count a little
constexpr std::size_t kFewestLandmarks = 4;  // of which the sphere has differentials

/// What is known of |φ|, made positive.
std::vector<double> positive(const Operators& operators, std::vector<double> densities) {
    double mean = 0;
    for (int s = 0; s < operators.sample_count(); ++s) mean += operators.weights[s] * densities[s] / operators.area();
    for (double& density : densities) density = std::max(density, kLeast * mean);
    return densities;
}

std::vector<double> of_torus(const Surface& source) {
    const std::vector<double> areas = flat_areas(flat_torus(source), source.mesh.faces);
    std::vector<double> of_faces(areas.size(), 0), densities;
    for (int s = 0; s < source.operators.sample_count(); ++s)
        of_faces[source.operators.faces[s]] += source.operators.weights[s];
    for (const int f : source.operators.faces) densities.push_back(areas[f] / of_faces[f]);
    return densities;
}

std::vector<double> of_landmarks(const Surface& source, std::span<const SphereLandmark> landmarks) {
    const ExtremalSphereMap map = extremal_sphere_map(source, sphere_map(source).positions, landmarks);
    std::vector<double> densities;
    for (const Complex phi : map.phi) densities.push_back(std::abs(phi));
    return densities;
}

const std::map<std::string, FlowScheme>& schemes() {
    static const std::map<std::string, FlowScheme> names{{"automatic", FlowScheme::automatic},
                                                         {"residual", FlowScheme::residual},
                                                         {"perturbation", FlowScheme::perturbation},
                                                         {"barrier", FlowScheme::barrier}};
    return names;
}

std::unique_ptr<Target> target_of(const OntoTarget& onto) {
    if (names_surface(onto.path())) return named_surface(onto.path());
    if (onto.domain()) return std::make_unique<DomainTarget>(*onto.domain());
    return std::make_unique<MeshTarget>(onto.surface()->mesh);
}

/// Of `ellipsoid:a,b,c`.
std::optional<Eigen::Vector3d> half_axes_of(const std::string& target) {
    const std::size_t colon = target.find(':');
    if (target.substr(0, colon) != "ellipsoid") return {};
    const auto n = number_list(target.substr(colon + 1));
    if (!n || n->size() != 3) return {};
    return Eigen::Vector3d((*n)[0], (*n)[1], (*n)[2]);
}

NaturalStart start_of(const AlongTarget::Request& request, const Target& target, const std::vector<CurveOnto>& curves,
                      Warnings& warnings) {
    if (!request.start_map.given()) {
        const OntoTarget& onto = request.onto;
        return natural_start(request.source, target,
                             {onto.surface() ? &*onto.surface() : nullptr, onto.domain() ? &*onto.domain() : nullptr,
                              half_axes_of(onto.path())},
                             curves);
    }
    const std::string& path = request.start_map.path();
    return {load_of_same_faces("--start-map", path, request.source.mesh, warnings).positions, path, {}};
}

std::vector<CurveOnto> curves_of(const AlongTarget::Request& request, const Target& target, Warnings& warnings) {
    if (!request.curves.given()) return {};
    MeshInput source = request.input;
    source.mesh = request.source.mesh;  // the input's own has been given away
    if (!request.onto.surface()) return request.curves.curves(source, target, warnings);
    MeshInput mesh;
    mesh.mesh = request.onto.surface()->mesh;
    mesh.numbers.resize(static_cast<std::size_t>(mesh.mesh.vertex_count()));
    std::iota(mesh.numbers.begin(), mesh.numbers.end(), 0);
    return request.curves.curves(source, mesh, warnings);
}

IndexedRows read_pins(const AlongTarget::Request& request) {
    return read_indexed_rows(request.pin_file, 1, static_cast<int>(request.input.numbers.size()), 3,
                             "a pinned vertex with its place x y z");
}

std::vector<int> pinned_vertices(const AlongTarget::Request& request) {
    std::vector<int> vertices;
    const IndexedRows rows = read_pins(request);
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
        vertices.push_back(request.input.number_of(rows.indices(i, 0), "a pinned vertex"));
    return vertices;
}

/// Puts pinned vertices where they are to be and holds them.
void pin(const AlongTarget::Request& request, Positions& start, TargetConstraints& constraints) {
    if (request.pin_file.empty()) return;
    const IndexedRows rows = read_pins(request);
    if (start.cols() == 2) {
        start.conservativeResize(Eigen::NoChange, 3);
        start.col(2).setZero();
    }
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        const int vertex = request.input.number_of(rows.indices(i, 0), "a pinned vertex");
        start.row(vertex) = rows.values.row(i);
        constraints.fixed.push_back(vertex);
    }
}

/// What the boundary keeps to, beside what is held already.
void hold_boundary(const Surface& source, std::string how, const Target& target, const Positions& start,
                   TargetConstraints& constraints) {
    if (!how.empty() && source.topology.boundary_loops.empty())
        throw Error(Cause::bad_option, "--boundary " + how + " says how the boundary moves, and SOURCE is closed",
                    "leave it out; --pin holds vertices");
    if (how.empty()) how = target.boundary().empty() ? "free" : "tangential";
    if (how == "tangential") slide_boundary(constraints, source, target, start);
    if (how != "fixed") return;
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : constraints.fixed) held[v] = 1;
    for (const TargetConstraints::Slide& slide : constraints.sliding) held[slide.vertex] = 1;
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        for (const int v : loop)
            if (!held[v]) constraints.fixed.push_back(v);
}

/// Pinned vertices on the sphere.
std::vector<SphereLandmark> landmarks_of(const Target& target, const AlongTarget::Request& request,
                                         const TargetMap& start) {
    std::vector<SphereLandmark> landmarks;
    if (request.pin_file.empty() || !dynamic_cast<const SphereTarget*>(&target)) return landmarks;
    for (const int vertex : pinned_vertices(request)) landmarks.push_back({vertex, start.points[vertex].position});
    return landmarks;
}

/// Of samples, from the densities of the source's own; empty: areas.
/// @param faces of the source, for those of the surface that is mapped; empty: they are the same
std::vector<double> weights_of(const Operators& own, const Operators& mapped, std::vector<double> densities,
                               const std::vector<int>& faces) {
    if (densities.empty()) return densities;
    std::vector<double> of_faces, counts;
    if (!faces.empty()) {
        const auto count = static_cast<std::size_t>(*std::max_element(own.faces.begin(), own.faces.end())) + 1;
        of_faces.assign(count, 0);
        counts.assign(count, 0);
        for (int s = 0; s < own.sample_count(); ++s) of_faces[own.faces[s]] += densities[s], counts[own.faces[s]] += 1;
    }
    std::vector<double> weights;
    for (int s = 0; s < mapped.sample_count(); ++s) {
        const int face = faces.empty() ? -1 : faces[mapped.faces[s]];
        weights.push_back(mapped.weights[s] * (face < 0 ? densities[s] : of_faces[face] / counts[face]));
    }
    return weights;
}

/// @throw Error bad_boundary where a curve leaves the domain
void require_inside(const TargetDomain& domain, const HeldCurves& held) {
    for (std::size_t c = 0; c < held.source.curves.size(); ++c)
        for (const int v : held.source.curves[c].vertices) {
            const Complex z(held.wanted(v, 0), held.wanted(v, 1));
            bool inside = domain.curve(0).contains(z);
            for (int hole = 1; hole < domain.curve_count(); ++hole) inside = inside && !domain.curve(hole).contains(z);
            if (!inside)
                throw Error(Cause::bad_boundary, "curve " + std::to_string(c + 1) + " leaves TARGET",
                            "give points of the domain, and more of them where it bends");
        }
}

/// The source's own part of a flow along its faces divided along curves.
void leave_out_curves(const Surface& own, const Target& target, const HeldCurves& held, SurfaceFlowMap& flow) {
    flow.map = own_part(own, target, held.constraints, flow.map);
    flow.distortion = distortion(own.operators, positions_of(flow.map.points), normals_of(flow.map.points));
    for (Warning& warning : flow.warnings) {
        if (warning.where.of != Things::faces) continue;
        for (int& face : warning.where.indices) face = held.source.faces[face];
        std::vector<int>& faces = warning.where.indices;
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
}

}  // namespace

void NormOption::add_to(CLI::App& app) {
    app.add_option("--minimize-lp", p_,
                   "in place of --mu, onto a surface in space: the map of least L^p norm of |mu|, p at least 2")
        ->check(CLI::Range(2.0, 1e3))
        ->type_name("P");
    app.add_option("--weight", weight_,
                   "of --minimize-lp: `area` of SOURCE; `phi`, that of the extremal map's quadratic differential, for "
                   "which already p = 2 gives that map: of closed surfaces of genus 1, and onto the sphere with four "
                   "or more vertices held by --pin; or FILE, the phi of another map of SOURCE, as map --phi writes it")
        ->capture_default_str()
        ->type_name("area|phi|FILE");
}

std::vector<NamedFile> NormOption::inputs() const {
    if (weight_ == "area" || weight_ == "phi") return {};
    return {{"--weight", weight_}};
}

std::vector<double> NormOption::densities(const Surface& source, std::span<const SphereLandmark> landmarks) const {
    if (weight_ == "area") return {};
    if (weight_ != "phi") return positive(source.operators, of_file(source));
    const Topology& topology = source.topology;
    const bool closed = topology.components == 1 && topology.boundary_loops.empty();
    if (closed && topology.genus == 1) return positive(source.operators, of_torus(source));
    if (closed && topology.genus == 0 && landmarks.size() >= kFewestLandmarks)
        return positive(source.operators, of_landmarks(source, landmarks));
    throw Error(Cause::bad_option,
                "--weight phi: the extremal map's quadratic differential is known at the start only of closed surfaces "
                "of genus 1 and, onto the sphere, of those of genus 0 with four or more pins",
                "give --weight area, or the file that `map --phi` writes of SOURCE");
}

std::vector<double> NormOption::of_file(const Surface& source) const {
    std::ifstream in(weight_);
    if (!in)
        throw Error(Cause::unreadable, "--weight " + weight_ + " is neither area nor phi, and no such file is there",
                    "check the path and permissions");
    const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
    const auto fail = [&](const std::string& what) {
        throw Error(Cause::unreadable, weight_ + " " + what, "give the file that `map --phi` writes of SOURCE");
    };
    if (!json.is_object() || !json.contains("phi") || !json["phi"].is_array()) fail("is no file of --phi");
    const auto& phi = json["phi"];
    if (static_cast<int>(phi.size()) != source.operators.sample_count())
        fail("has " + std::to_string(phi.size()) + " samples of phi, SOURCE " +
             std::to_string(source.operators.sample_count()));
    std::vector<double> densities;
    double sum = 0;
    for (const auto& value : phi) {
        if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
            fail("has a phi that is not two numbers");
        densities.push_back(std::hypot(value[0].get<double>(), value[1].get<double>()));
        sum += densities.back();
    }
    if (!(sum > 0)) fail("has phi = 0 everywhere: the map is conformal and no norm is to be weighed");
    return densities;
}

void AlongTarget::add_to(CLI::App& app) {
    norm_.add_to(app);
    app.add_option("--scheme", scheme_,
                   "onto a surface in space: steps for the residual, by the perturbation of mu (Wong and Zhao), or "
                   "against a barrier that no face crosses; automatic: in this order, the last as soon as it does")
        ->check(CLI::IsMember({"automatic", "residual", "perturbation", "barrier"}))
        ->capture_default_str();
}

std::string AlongTarget::stray() const {
    if (norm_.given()) return "--minimize-lp";
    if (norm_.weighted()) return "--weight";
    return scheme_ == "automatic" ? "" : "--scheme";
}

bool AlongTarget::says_how_it_moves(const std::string& boundary) {
    return boundary == "fixed" || boundary == "tangential" || boundary == "free";
}

bool AlongTarget::flat(const OntoTarget& onto) {
    return onto.domain() || onto.path() == "plane";
}

SurfaceFlowMap AlongTarget::flow(const Request& request, const Target& target, const Surface& source,
                                 const std::vector<int>& faces, const std::optional<Eigen::VectorXcd>& mu,
                                 const TargetConstraints& constraints, TargetMap start,
                                 SurfaceFlowRecord& record) const {
    record.held = static_cast<int>(constraints.fixed.size());
    record.sliding = static_cast<int>(constraints.sliding.size());
    SurfaceFlowOptions options = request.options;
    options.scheme = schemes().at(scheme_);
    if (mu) return surface_flow(source, target, *mu, constraints, std::move(start), options);
    record.p = norm_.p();
    record.weight = norm_.weight();
    LpNorm norm{norm_.p(), norm_.densities(request.source, landmarks_of(target, request, start))};
    norm.weights = weights_of(request.source.operators, source.operators, std::move(norm.weights), faces);
    return least_lp_map(source, target, norm, constraints, std::move(start), options);
}

SurfaceFlowMap AlongTarget::flow_with_curves(const Request& request, const Target& target,
                                             const std::vector<CurveOnto>& curves, NaturalStart start,
                                             SurfaceFlowRecord& record, Warnings& warnings) const {
    HeldCurves held = held_curves(request.source.mesh, target, curves, std::move(start));
    if (request.onto.domain()) require_inside(*request.onto.domain(), held);
    const Surface source(held.source.mesh);
    pin(request, held.wanted, held.constraints);
    hold_boundary(source, request.boundary, target, held.wanted, held.constraints);
    LedMap led = led_start(source, target, held);
    if (led.flips > 0)
        warnings.push_back({WarningKind::start, fmt::format("the start that obeys the curves has {} flipped",
                                                            counted(led.flips, "face", "faces"))});
    std::optional<Eigen::VectorXcd> mu;
    if (request.mu) mu = mu_along_curves(request.source, held.source, source, *request.mu);
    SurfaceFlowMap result =
        flow(request, target, source, held.source.faces, mu, held.constraints, std::move(led.map), record);
    if (!result.distortion.flipped.empty())
        throw Error(Cause::not_solved,
                    counted(result.distortion.flipped.size(), "face stays", "faces stay") +
                        " flipped: the curves are not reached from this start without folds",
                    "give curves that run alike on both surfaces, fewer of them, or another --start-map");
    leave_out_curves(request.source, target, held, result);
    if (!result.distortion.flipped.empty())
        warnings.push_back({WarningKind::flipped_faces,
                            std::to_string(result.distortion.flipped.size()) +
                                " faces that a curve crosses are flipped where they are drawn straight; divided along "
                                "the curve none is",
                            {Things::faces, result.distortion.flipped}});
    return result;
}

SurfaceFlowMap AlongTarget::run(const Request& request, SurfaceFlowRecord& record, Warnings& warnings) const {
    const std::unique_ptr<Target> target = target_of(request.onto);
    record.target = request.onto.path();
    const std::vector<CurveOnto> curves = curves_of(request, *target, warnings);
    NaturalStart start = start_of(request, *target, curves, warnings);
    record.start = start.name;
    SurfaceFlowMap result = [&] {
        if (!curves.empty()) return flow_with_curves(request, *target, curves, std::move(start), record, warnings);
        TargetConstraints constraints;
        pin(request, start.positions, constraints);
        hold_boundary(request.source, request.boundary, *target, start.positions, constraints);
        return flow(request, *target, request.source, {}, request.mu, constraints,
                    target_map(request.source, *target, constraints, start.positions), record);
    }();
    record.error = result.error;
    record.fits = result.fits;
    record.history = result.history;
    append(warnings, result.warnings);
    return result;
}

}  // namespace beltrami::cli
