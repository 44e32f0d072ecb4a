#include <beltrami/targets/target_mesh.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/delaunay.h>
#include <beltrami/plane/curve_meeting.h>

namespace beltrami {

namespace {

/// A part of a curve between corners, or a whole curve without any, cut into pieces.
struct Run {
    int curve;
    std::vector<double> cuts;  ///< ascending parameters from its begin to its end
};

std::vector<Run> runs_of(const TargetDomain& domain) {
    std::vector<Run> runs;
    for (int c = 0; c < domain.curve_count(); ++c) {
        std::vector<double> ends = domain.curve(c).corners();
        if (ends.empty()) ends.push_back(0);
        ends.push_back(ends.front() + domain.curve(c).length());
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) runs.push_back({c, {ends[i], ends[i + 1]}});
    }
    return runs;
}

/// Cuts a run as long as wanted at its places.
void cut(Run& run, const TargetDomain& domain, double edge_length, const TargetMeshOptions& options) {
    const TargetCurve& curve = domain.curve(run.curve);
    const double begin = run.cuts[0], length = run.cuts[1] - begin;
    const bool at_hole = run.curve > 0 && options.hole_edge_length > 0;
    const double most =
        std::min(at_hole ? options.hole_edge_length : edge_length, curve.length() / options.least_edges);
    const auto size = [&](double t) {
        const double bend = std::abs(curve.curvature(begin + t * length));
        return bend * most > options.max_turn ? options.max_turn / bend : most;
    };
    const std::vector<double> t = spread(length, size);
    run.cuts.clear();
    for (const double at : t) run.cuts.push_back(begin + at * length);
}

/// A piece of a run with its neighbours around the curve.
struct Piece {
    int run, position;
    int before, after;  ///< pieces
    detail::CurveArc arc;
};

std::vector<Piece> pieces_of(const std::vector<Run>& runs, const TargetDomain& domain) {
    std::vector<Piece> pieces;
    for (std::size_t r = 0, first = 0; r < runs.size(); ++r) {
        const bool opens = r == 0 || runs[r - 1].curve != runs[r].curve;
        if (opens) first = pieces.size();
        const TargetCurve& curve = domain.curve(runs[r].curve);
        for (std::size_t i = 0; i + 1 < runs[r].cuts.size(); ++i) {
            const int self = static_cast<int>(pieces.size());
            pieces.push_back({static_cast<int>(r), static_cast<int>(i), self - 1, self + 1,
                              detail::curve_arc(curve, runs[r].cuts[i], runs[r].cuts[i + 1])});
        }
        if (r + 1 == runs.size() || runs[r + 1].curve != runs[r].curve) {
            pieces.back().after = static_cast<int>(first);
            pieces[first].before = static_cast<int>(pieces.size()) - 1;
        }
    }
    return pieces;
}

/// Pieces that turn too much, or are not further from others than both may be from their chords.
std::vector<char> too_long(const std::vector<Piece>& pieces, const std::vector<Run>& runs, const TargetDomain& domain,
                           const TargetMeshOptions& options) {
    std::vector<char> found(pieces.size(), 0);
    std::vector<Segment> chords;
    double widest = 0;
    for (const Piece& piece : pieces) {
        chords.push_back(piece.arc.chord);
        widest = std::max(widest, piece.arc.width);
    }
    const SegmentTree tree(chords);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        const TargetCurve& curve = domain.curve(runs[piece.run].curve);
        if (curve.kind() == TargetCurve::Kind::spline) {
            const double turn = std::arg(curve.tangent(piece.arc.end) / curve.tangent(piece.arc.begin));
            if (std::abs(turn) > 1.5 * options.max_turn) found[i] = 1;
        }
        SegmentTree::Box box = SegmentTree::Box::of(piece.arc.chord);
        const double margin = piece.arc.width + widest;
        box.left -= margin, box.right += margin, box.low -= margin, box.high += margin;
        tree.for_each(box, [&](int j) {
            if (j <= static_cast<int>(i) || j == piece.after || j == piece.before) return;
            const double width = piece.arc.width + pieces[j].arc.width;
            if (width == 0 || detail::distance(piece.arc.chord, pieces[j].arc.chord) > width) return;
            (piece.arc.width >= pieces[j].arc.width ? found[i] : found[j]) = 1;
        });
    }
    return found;
}

void halve(std::vector<Run>& runs, const std::vector<Piece>& pieces, const std::vector<char>& chosen) {
    std::vector<std::vector<double>> cuts(runs.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        std::vector<double>& of_run = cuts[pieces[i].run];
        of_run.push_back(pieces[i].arc.begin);
        if (chosen[i]) of_run.push_back(0.5 * (pieces[i].arc.begin + pieces[i].arc.end));
    }
    for (std::size_t r = 0; r < runs.size(); ++r) {
        cuts[r].push_back(runs[r].cuts.back());
        runs[r].cuts = std::move(cuts[r]);
    }
}

/// Curves and parameters of the boundary vertices that the triangulation added, by the loops on which they lie.
/// @throw Error not_solved unless every loop runs once along one curve
void place_boundary(TargetMesh& result, const TargetDomain& domain) {
    const Topology topo = topology(result.mesh);
    const auto astray = [](int vertex) {
        return Error(Cause::not_solved, "the mesh of the target domain does not follow its curves",
                     "give shorter edges", {Things::vertices, {vertex}});
    };
    if (topo.boundary_loops.size() != static_cast<std::size_t>(domain.curve_count())) throw astray(0);
    for (const std::vector<int>& loop : topo.boundary_loops) {
        int c = -1;
        for (const int v : loop) c = std::max(c, result.curve[v]);
        if (c < 0) throw astray(loop[0]);
        const TargetCurve& curve = domain.curve(c);
        for (const int v : loop) {
            if (result.curve[v] == c) continue;
            if (result.curve[v] >= 0) throw astray(v);
            result.curve[v] = c;
            result.parameter[v] = curve.nearest({result.mesh.positions(v, 0), result.mesh.positions(v, 1)});
        }
        double around = 0;
        for (std::size_t i = 0; i < loop.size(); ++i)
            around += curve.ahead(result.parameter[loop[i]], result.parameter[loop[(i + 1) % loop.size()]]);
        if (!(std::abs(around - curve.length()) < 1e-6 * curve.length())) throw astray(loop[0]);
        result.curve_of_loop.push_back(c);
    }
}

}  // namespace

void TargetMeshOptions::validate() const {
    const auto require = [](bool good, const char* name, double value, const char* wanted) {
        if (!good) throw Error(Cause::bad_option, std::string(name) + " is " + std::to_string(value), wanted);
    };
    require(edge_length >= 0 && std::isfinite(edge_length), "edge_length", edge_length,
            "give a positive length, or 0 for a fitting one");
    require(hole_edge_length >= 0 && std::isfinite(hole_edge_length), "hole_edge_length", hole_edge_length,
            "give a positive length, or 0 for edge_length");
    require(least_edges >= 6 && least_edges <= 1'000'000, "least_edges", least_edges, "give 6 to a million");
    require(max_turn > 0 && max_turn <= 0.5, "max_turn", max_turn, "give an angle above 0 and at most 0.5 radians");
}

TargetMesh target_mesh(const TargetDomain& domain, const TargetMeshOptions& options) {
    options.validate();
    validate(domain);
    constexpr double kUsualVertices = 5000;
    const double triangle = std::sqrt(3.0) / 4, area = domain.area();
    const double h = options.edge_length > 0 ? options.edge_length : std::sqrt(area / (2 * kUsualVertices * triangle));
    if (!(area < 4e7 * triangle * h * h))
        throw Error(Cause::bad_option,
                    "edges of length " + std::to_string(h) +
                        " would make more than 40 million "
                        "triangles",
                    "give a larger edge_length");

    std::vector<Run> runs = runs_of(domain);
    for (Run& run : runs) cut(run, domain, h, options);
    std::vector<Piece> pieces = pieces_of(runs, domain);
    constexpr int kMostRounds = 64;
    for (int round = 0; round < kMostRounds; ++round) {
        const std::vector<char> chosen = too_long(pieces, runs, domain, options);
        if (std::find(chosen.begin(), chosen.end(), 1) == chosen.end()) break;
        halve(runs, pieces, chosen);
        pieces = pieces_of(runs, domain);
    }

    TargetMesh result;
    PlanarDomain planar;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        const int c = runs[piece.run].curve;
        planar.points.emplace_back(piece.arc.chord.a.real(), piece.arc.chord.a.imag());
        planar.segments.push_back({static_cast<int>(i), piece.after});
        planar.curves.push_back(piece.run);
        result.curve.push_back(c);
        result.parameter.push_back(domain.curve(c).wrap(piece.arc.begin));
    }
    planar.project = [&](int run, const Eigen::Vector2d& p) -> Eigen::Vector2d {
        const TargetCurve& curve = domain.curve(runs[run].curve);
        const Complex z = curve.point(curve.nearest({p.x(), p.y()}));
        return {z.real(), z.imag()};
    };
    TriangulateOptions triangulate_options;
    triangulate_options.size = [h](const Eigen::Vector2d&) { return h; };
    triangulate_options.min_angle = options.min_angle;
    triangulate_options.split_ears = options.split_ears;
    result.mesh = triangulate(planar, triangulate_options);
    result.curve.resize(result.mesh.vertex_count(), -1);
    result.parameter.resize(result.mesh.vertex_count(), 0.0);
    place_boundary(result, domain);
    return result;
}

}  // namespace beltrami
