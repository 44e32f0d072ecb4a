#include "along_target.h"

#include <cmath>
#include <map>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/uniformize/sphere_map.h>

#include "space_target.h"

namespace beltrami::cli {

namespace {

/// A source whose vertices are no further from the target, in parts of its size, lies on it.
constexpr double kOnTarget = 1e-6;

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

bool lies_on(const Mesh& source, const Target& target) {
    const Target::Points nearest = nearest_points(target, source.positions);
    const Positions& points = source.positions;
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    for (int v = 0; v < source.vertex_count(); ++v)
        if ((nearest[v].position - source.point(v)).norm() > kOnTarget * size) return false;
    return true;
}

/// Of a surface of genus 1 on a torus: the shorter loop of its lattice goes around the small circle.
Positions around(const ParametricTarget& torus, const FlatTorus& flat) {
    Positions start(flat.lattice.rows(), 3);
    for (Eigen::Index v = 0; v < start.rows(); ++v)
        start.row(v) = torus.at(-flat.lattice(v, 1), flat.lattice(v, 0)).position;
    return start;
}

/// Where the iteration begins that is given no start.
Positions natural_start(const Surface& source, const Target& target, const OntoTarget& onto, std::string& name) {
    const Topology& topology = source.topology;
    const bool closed = topology.components == 1 && topology.boundary_loops.empty();
    if (lies_on(source.mesh, target)) {
        name = "identity";
        return source.mesh.positions;
    }
    if (closed && topology.genus == 0 && dynamic_cast<const SphereTarget*>(&target)) {
        name = "conformal";
        return sphere_map(source).positions;
    }
    const auto* torus = dynamic_cast<const ParametricTarget*>(&target);
    if (closed && topology.genus == 1 && torus && torus->boundary().empty()) {
        name = "lattice";
        return around(*torus, flat_torus(source));
    }
    const Topology* other = onto.surface() ? &onto.surface()->topology : nullptr;
    if (closed && topology.genus == 0 && other && other->components == 1 && other->boundary_loops.empty() &&
        other->genus == 0) {
        name = "conformal";
        return register_spheres(source, *onto.surface(), {}).positions;
    }
    throw Error(Cause::bad_option, "a flow onto " + onto.path() + " needs a start: SOURCE does not lie on it",
                "give --start-map, a mesh of SOURCE's faces whose vertices stand near their images");
}

Positions start_of(const AlongTarget::Request& request, const Target& target, std::string& name, Warnings& warnings) {
    if (!request.start_map.given()) return natural_start(request.source, target, request.onto, name);
    name = request.start_map.path();
    return load_of_same_faces("--start-map", name, request.source.mesh, warnings).positions;
}

/// Puts pinned vertices where they are to be and holds them.
void pin(const AlongTarget::Request& request, Positions& start, TargetConstraints& constraints) {
    if (request.pin_file.empty()) return;
    const IndexedRows rows = read_indexed_rows(request.pin_file, 1, static_cast<int>(request.input.numbers.size()), 3,
                                               "a pinned vertex with its place x y z");
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

TargetConstraints held(const AlongTarget::Request& request, const Target& target, Positions& start) {
    TargetConstraints constraints;
    pin(request, start, constraints);
    const auto& loops = request.source.topology.boundary_loops;
    std::string how = request.boundary;
    if (how.empty()) how = target.boundary().empty() ? "free" : "tangential";
    if (how == "tangential") slide_boundary(constraints, request.source, target, start);
    if (how == "fixed") {
        std::vector<char> pinned(static_cast<std::size_t>(request.source.mesh.vertex_count()), 0);
        for (const int v : constraints.fixed) pinned[v] = 1;
        for (const std::vector<int>& loop : loops)
            for (const int v : loop)
                if (!pinned[v]) constraints.fixed.push_back(v);
    }
    return constraints;
}

}  // namespace

void AlongTarget::add_to(CLI::App& app) {
    app.add_option("--minimize-lp", p_,
                   "in place of --mu, onto a surface in space: the map of least L^p norm of |mu|, p at least 2")
        ->check(CLI::Range(2.0, 1e3))
        ->type_name("P");
    app.add_option("--weight", weight_,
                   "of --minimize-lp: areas of SOURCE, or, on a closed surface of genus 1, those of its quadratic "
                   "differential phi, for which already p = 2 gives the extremal map")
        ->check(CLI::IsMember({"area", "phi"}))
        ->capture_default_str();
    app.add_option("--scheme", scheme_,
                   "onto a surface in space: steps for the residual, by the perturbation of mu (Wong and Zhao), or "
                   "against a barrier that no face crosses; automatic: in this order, the last as soon as it does")
        ->check(CLI::IsMember({"automatic", "residual", "perturbation", "barrier"}))
        ->capture_default_str();
}

std::string AlongTarget::stray() const {
    if (p_) return "--minimize-lp";
    if (weight_ != "area") return "--weight";
    return scheme_ == "automatic" ? "" : "--scheme";
}

bool AlongTarget::says_how_it_moves(const std::string& boundary) {
    return boundary == "fixed" || boundary == "tangential" || boundary == "free";
}

bool AlongTarget::flat(const OntoTarget& onto) {
    return onto.domain() || onto.path() == "plane";
}

LpNorm AlongTarget::norm(const Surface& source) const {
    LpNorm norm{*p_, {}};
    if (weight_ == "area") return norm;
    const Topology& topology = source.topology;
    if (topology.components != 1 || topology.genus != 1 || !topology.boundary_loops.empty())
        throw Error(
            Cause::bad_option,
            "--weight phi is for closed surfaces of genus 1, whose quadratic differential is known at the start",
            "give --weight area");
    const std::vector<double> areas = flat_areas(flat_torus(source), source.mesh.faces);
    for (const int f : source.operators.faces)
        norm.weights.push_back(areas[f] / static_cast<double>(source.mesh.faces.degree(f) == 3 ? 1 : 4));
    return norm;
}

SurfaceFlowMap AlongTarget::run(const Request& request, SurfaceFlowRecord& record, Warnings& warnings) const {
    const std::unique_ptr<Target> target = target_of(request.onto);
    record.target = request.onto.path();
    Positions start = start_of(request, *target, record.start, warnings);
    const TargetConstraints constraints = held(request, *target, start);
    record.held = static_cast<int>(constraints.fixed.size());
    record.sliding = static_cast<int>(constraints.sliding.size());
    SurfaceFlowOptions options = request.options;
    options.scheme = schemes().at(scheme_);
    TargetMap map = target_map(request.source, *target, constraints, start);
    SurfaceFlowMap flow = [&] {
        if (request.mu) return surface_flow(request.source, *target, *request.mu, constraints, std::move(map), options);
        record.p = *p_;
        record.weight = weight_;
        return least_lp_map(request.source, *target, norm(request.source), constraints, std::move(map), options);
    }();
    record.error = flow.error;
    record.fits = flow.fits;
    record.history = flow.history;
    append(warnings, flow.warnings);
    return flow;
}

}  // namespace beltrami::cli
