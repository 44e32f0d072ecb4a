#include <beltrami/charts/greens_function.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/uniformize/flatten.h>

namespace beltrami {

namespace {

/// Faces of the patch: the error of Green's function falls with the square of its radius in edges, its cost grows with
/// its faces.
constexpr int kPatchPart = 16, kFewestPatchFaces = 500;
/// Where the patch's rim comes as near to the pole as this many radii of the faces there, the patch is too small.
constexpr double kLeastEdges = 4;
constexpr double kFlattenTolerance = 1e-8;

int face_across(const Topology& topology, int face, int corner) {
    const auto& sides = topology.edge_faces[topology.corner_edges[corner]];
    return sides[0] == face ? sides[1] : sides[0];
}

/// Faces around a vertex, a topological disk: the vertex's own, then always the deepest that keeps it a disk, so that
/// the numbering makes no difference.
/// @param depth #V
std::vector<int> patch_around(const Surface& source, int pole, const Eigen::VectorXd& depth, int count) {
    const FaceList& faces = source.mesh.faces;
    std::vector<char> in_patch(faces.size(), 0), used(source.mesh.vertex_count(), 0);
    std::vector<int> patch;
    std::priority_queue<std::pair<double, int>> waiting;
    const auto depth_of = [&](int f) {
        double least = std::numeric_limits<double>::infinity();
        for (const int v : faces[f]) least = std::min(least, depth[v]);
        return least;
    };
    const auto add = [&](int f) {
        in_patch[f] = 1;
        patch.push_back(f);
        for (const int v : faces[f]) used[v] = 1;
        for (int c = faces.first_corner(f), end = c + faces.degree(f); c < end; ++c)
            if (const int other = face_across(source.topology, f, c); other >= 0 && !in_patch[other])
                waiting.emplace(depth_of(other), other);
    };
    for (int f = 0; f < faces.size(); ++f)
        for (const int v : faces[f])
            if (v == pole) add(f);
    while (!waiting.empty() && static_cast<int>(patch.size()) < count) {
        const int f = waiting.top().second;
        waiting.pop();
        if (in_patch[f]) continue;
        int shared_edges = 0, shared_vertices = 0;
        for (const int v : faces[f]) shared_vertices += used[v];
        for (int c = faces.first_corner(f), end = c + faces.degree(f); c < end; ++c) {
            const int other = face_across(source.topology, f, c);
            shared_edges += other >= 0 && in_patch[other];
        }
        // One chain of edges, and no vertex beside it. Otherwise its turn comes again with a later neighbour.
        if (shared_vertices == shared_edges + 1 || shared_edges == faces.degree(f)) add(f);
    }
    std::sort(patch.begin(), patch.end());
    return patch;
}

Flattening flatten_patch(const Surface& source, const Submesh& patch) {
    FlattenOptions options;
    options.tolerance = kFlattenTolerance;
    if (!source.metric) return flatten(patch.mesh, options);
    Positions corners(patch.mesh.faces.corner_count(), source.metric->cols());
    for (int f = 0; f < patch.mesh.face_count(); ++f)
        corners.middleRows(patch.mesh.faces.first_corner(f), patch.mesh.faces.degree(f)) =
            source.metric->middleRows(source.mesh.faces.first_corner(patch.faces[f]), patch.mesh.faces.degree(f));
    return flatten(patch.mesh, corners, options);
}

/// 1, a turn of 2π, at the corners left of a path of faces from one at the pole to the boundary, 0 elsewhere: along the
/// path the angle jumps, so its differences inside faces have the period 2π around the pole and nowhere else.
/// @param exit the corner at which the boundary edge begins where the path ends
std::vector<char> turns_at_cut(const Surface& source, int first_face, int* exit_corner) {
    const FaceList& faces = source.mesh.faces;
    std::vector<int> entered_by(faces.size(), -1);  // corner, of the face before, across whose edge the path came
    std::vector<int> queue{first_face};
    std::vector<char> reached(faces.size(), 0);
    std::vector<int> before(faces.size(), -1);
    reached[first_face] = 1;
    int last = -1, exit = -1;
    for (std::size_t head = 0; head < queue.size() && last < 0; ++head) {
        const int f = queue[head];
        for (int c = faces.first_corner(f), end = c + faces.degree(f); c < end; ++c) {
            const int other = face_across(source.topology, f, c);
            if (other < 0) {
                last = f;
                exit = c;
                break;
            }
            if (reached[other]) continue;
            reached[other] = 1;
            before[other] = f;
            entered_by[other] = c;
            queue.push_back(other);
        }
    }
    *exit_corner = exit;
    std::vector<char> turns(faces.corner_count(), 0);
    for (int f = last; f != first_face; exit = entered_by[f], f = before[f]) {
        const int begin = faces.first_corner(f), degree = faces.degree(f);
        const int edge = source.topology.corner_edges[entered_by[f]];
        int entrance = begin;
        while (source.topology.corner_edges[entrance] != edge) ++entrance;
        // Counter-clockwise from the exit's end to the entrance's start lies what is on the left.
        for (int c = exit; c != entrance;) {
            c = c + 1 < begin + degree ? c + 1 : begin;
            turns[c] = 1;
        }
    }
    return turns;
}

/// log w on the patch: what h + ih* is added to.
struct Singular {
    Eigen::VectorXcd logarithm;  ///< #V log w on the patch, its angle less the turns at the cut; else 0
    Eigen::VectorXcd factor;     ///< #V w on the patch, else 1
    Eigen::VectorXcd offset;     ///< #S ∂̄ of the logarithm outside the patch, else 0
    int cut_corner = -1;         ///< where the boundary edge begins along which the logarithm turns by 2πi
};

std::optional<Singular> singular_part(const Surface& source, int pole, const Eigen::VectorXd& depth) {
    const FaceList& faces = source.mesh.faces;
    const Operators& operators = source.operators;
    const int n = source.mesh.vertex_count();
    const Submesh patch = keep_faces(
        source.mesh, patch_around(source, pole, depth, std::max(kFewestPatchFaces, faces.size() / kPatchPart)));
    const Flattening flat = flatten_patch(source, patch);
    if (!flat.flipped.empty()) return {};

    Singular result{Eigen::VectorXcd::Zero(n), Eigen::VectorXcd::Ones(n),
                    Eigen::VectorXcd::Zero(operators.sample_count())};
    const int pole_in_patch =
        static_cast<int>(std::lower_bound(patch.vertices.begin(), patch.vertices.end(), pole) - patch.vertices.begin());
    const Eigen::VectorXcd w = flat.positions.array() - flat.positions[pole_in_patch];
    for (int i = 0; i < patch.mesh.vertex_count(); ++i) {
        result.factor[patch.vertices[i]] = w[i];
        if (i != pole_in_patch && w[i] == 0.0) return {};
    }

    // Angles from face to face, over the faces of the patch that do not touch the pole.
    int pole_face = -1, start = -1;
    std::vector<char> in_patch(faces.size(), 0), waiting(faces.size(), 0);
    double radius_at_pole = 0, radius = std::numeric_limits<double>::infinity();
    for (const int f : patch.faces) in_patch[f] = 1;
    for (const int f : patch.faces) {
        const auto at = faces[f];
        if (std::find(at.begin(), at.end(), pole) == at.end()) {
            waiting[f] = 1;
            if (start < 0) start = f;
        } else {
            pole_face = f;
            for (const int v : at) radius_at_pole = std::max(radius_at_pole, std::abs(result.factor[v]));
        }
        for (int c = faces.first_corner(f), end = c + faces.degree(f); c < end; ++c)
            if (const int other = face_across(source.topology, f, c); other < 0 || !in_patch[other])
                radius = std::min(radius, std::abs(result.factor[faces.vertices()[c]]));
    }
    if (start < 0 || !(radius > kLeastEdges * radius_at_pole)) return {};
    const std::vector<char> turns = turns_at_cut(source, pole_face, &result.cut_corner);
    const auto turn = [&](int corner) { return turns[corner] ? kTurn : 0.0; };
    std::vector<char> known(n, 0);
    std::vector<int> queue{start};
    waiting[start] = 0;
    const auto set = [&](int v, double angle) {
        result.logarithm[v] = Complex(std::log(std::abs(result.factor[v])), angle);
        known[v] = 1;
    };
    const int first = faces.first_corner(start), first_vertex = faces.vertices()[first];
    set(first_vertex, std::arg(result.factor[first_vertex]) - turn(first));
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const int f = queue[head], begin = faces.first_corner(f), end = begin + faces.degree(f);
        int from = begin;
        while (!known[faces.vertices()[from]]) ++from;
        const int a = faces.vertices()[from];
        for (int c = begin; c < end; ++c) {
            const int b = faces.vertices()[c];
            const double angle = result.logarithm[a].imag() + turn(from) +
                                 std::arg(result.factor[b] * std::conj(result.factor[a])) - turn(c);
            if (!known[b]) set(b, angle);
            // Where faces disagree the flattening winds around the pole somewhere else too.
            if (std::abs(angle - result.logarithm[b].imag()) > 1e-3) return {};
            if (const int other = face_across(source.topology, f, c); other >= 0 && waiting[other]) {
                waiting[other] = 0;
                queue.push_back(other);
            }
        }
    }

    parallel_for(0, operators.sample_count(), [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const auto stencil = operators.stencil(s);
            const auto gradient = operators.gradient(s);
            if (in_patch[operators.faces[s]]) continue;
            const int corner = faces.first_corner(operators.faces[s]);
            Complex sum = 0;
            for (std::size_t j = 0; j < stencil.size(); ++j)
                sum += gradient[j] * (result.logarithm[stencil[j]] + Complex(0, turn(corner + static_cast<int>(j))));
            result.offset[s] = 0.5 * sum;
        }
    });
    return result;
}

Eigen::VectorXcd conjugate_by_system(const Surface& source, const Eigen::VectorXd& h, const Eigen::VectorXcd& offset) {
    std::vector<Freedom> freedom(h.size(), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices()) freedom[v] = Freedom::sliding;
    freedom[source.topology.boundary_loops[0][0]] = Freedom::fixed;
    BeltramiSolver conjugate(source, freedom, 1);
    conjugate.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()),
                        Eigen::VectorXcd::Constant(h.size(), Complex(0, 1)));
    return conjugate.solve(h.cast<Complex>(), offset);
}

Eigen::VectorXcd conjugate_by_flux(const Surface& source, const BeltramiSolver& dirichlet, const Eigen::VectorXd& h,
                                   const Eigen::VectorXcd& offset, int cut_corner) {
    // ∫ v dh* along the boundary = 2 Re Σ 2A conj(∂̄v)(∂̄h + r) for every v: what h, solved for inside, leaves at
    // the boundary vertices.
    const Operators& operators = source.operators;
    const auto& on_boundary = source.topology.on_boundary;
    const Eigen::VectorXcd values = h.cast<Complex>();
    Eigen::VectorXd increase = Eigen::VectorXd::Zero(h.size());
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        if (std::none_of(stencil.begin(), stencil.end(), [&](int v) { return on_boundary[v]; })) continue;
        const Complex residual = operators.derivatives(s, values)[1] + (offset.size() ? offset[s] : Complex(0));
        for (std::size_t j = 0; j < stencil.size(); ++j)
            increase[stencil[j]] +=
                2 * operators.weights[s] * std::real(std::conj(operators.gradient(s)[j]) * residual);
    }
    const auto& loop = source.topology.boundary_loops[0];
    const auto& lengths = source.boundary_edge_lengths[0];
    const auto cut =
        cut_corner < 0 ? loop.end() : std::find(loop.begin(), loop.end(), source.mesh.faces.vertices()[cut_corner]);
    const std::size_t last_before_cut = static_cast<std::size_t>(cut - loop.begin());
    if (cut != loop.end())  // half of the turn on either half of the edge
        for (const std::size_t i : {last_before_cut, last_before_cut + 1})
            increase[loop[i % loop.size()]] += 0.5 * kTurn;
    // From the middle of the edge before a vertex to the middle of the edge after it; at the vertex between the two.
    Eigen::VectorXcd boundary = values;
    double middle = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const double before = lengths[(i + loop.size() - 1) % loop.size()], after = lengths[i];
        const double whole = middle + increase[loop[i]] * before / (before + after);
        boundary[loop[i]].imag(whole - (i > last_before_cut ? kTurn : 0.0));
        middle += increase[loop[i]];
    }
    return dirichlet.solve(boundary, offset);
}

}  // namespace

Eigen::VectorXcd with_conjugate(const Surface& source, const BeltramiSolver& dirichlet, ConjugateBy way,
                                const Eigen::VectorXd& h, const Eigen::VectorXcd& offset, int cut_corner,
                                int* factorizations) {
    if (way == ConjugateBy::flux) return conjugate_by_flux(source, dirichlet, h, offset, cut_corner);
    ++*factorizations;
    return conjugate_by_system(source, h, offset);
}

std::optional<GreensFunction> greens_function(const Surface& source, const BeltramiSolver& dirichlet) {
    // −Δψ = 1, ψ = 0 on the boundary, is largest deep inside.
    const Eigen::VectorXd depth = dirichlet.solve_poisson(vertex_areas(source.operators));
    int pole = -1;
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v] && (pole < 0 || depth[v] > depth[pole])) pole = v;
    if (pole < 0) return {};
    std::optional<Singular> singular;
    try {
        singular = singular_part(source, pole, depth);
    } catch (const Error&) {  // the patch cannot be flattened by itself
    }
    if (!singular) return {};
    Eigen::VectorXd h = dirichlet.solve(Eigen::VectorXcd::Zero(source.mesh.vertex_count()), singular->offset).real();
    return GreensFunction{std::move(h), std::move(singular->factor), std::move(singular->offset), singular->cut_corner};
}

Eigen::VectorXcd disk_map_by_greens_function(const Surface& source, const BeltramiSolver& dirichlet,
                                             const GreensFunction& of, ConjugateBy way, int* factorizations) {
    const Eigen::VectorXcd sum =
        with_conjugate(source, dirichlet, way, of.regular, of.offset, of.cut_corner, factorizations);
    Eigen::VectorXcd g(sum.size());
    parallel_for(0, static_cast<int>(g.size()), [&](int begin, int end) {
        for (int v = begin; v < end; ++v) g[v] = of.factor[v] * std::exp(sum[v]);
    });
    return g;
}

std::optional<Eigen::VectorXcd> disk_map_by_greens_function(const Surface& source, const BeltramiSolver& dirichlet,
                                                            ConjugateBy way, int* factorizations) {
    const auto of = greens_function(source, dirichlet);
    if (!of) return {};
    return disk_map_by_greens_function(source, dirichlet, *of, way, factorizations);
}

}  // namespace beltrami
