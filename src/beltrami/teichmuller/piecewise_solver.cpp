#include <beltrami/teichmuller/piecewise_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/certificate/attained_dilatation.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/mesh/boundary_position.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/teichmuller/record.h>

namespace beltrami {

PiecewiseSolver::PiecewiseSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                                 PreparedProblem prepared, std::vector<ProblemPiece> pieces)
    : options_(options),
      boundary_(constraints.prescribed),
      outer_loop_(constraints.correspondence.outer_loop),
      prepared_(std::move(prepared)),
      source_(prepared_.surface_of(source)),
      pieces_(std::move(pieces)) {
    std::optional<Eigen::VectorXcd> start = options_.start;
    if (start && prepared_.split) start = with_parents_means(*start, prepared_.split->parents);
    for (const ProblemPiece& piece : pieces_) {
        ExtremalOptions own = options_;
        Constraints constraints_of_piece(piece.boundary);
        constraints_of_piece.correspondence.outer_loop = piece.outer_loop;
        own.split_prescribed = false;  // done for the whole
        if (start) own.start = (*start)(piece.vertices);
        if (options_.progress)
            own.progress = [this](int iteration, double k) {
                return options_.progress(iterations_before_ + iteration, k);
            };
        solvers_.emplace_back(piece.surface, constraints_of_piece, own);
    }
    if (source_.topology.boundary_loops.size() > 1) {
        Eigen::VectorXcd places;
        if (const Eigen::VectorXcd* z = source_.coordinate(); z && outer_loop_ == 0) {
            places = *z;
        } else {
            const Chart chart = domain_chart(source_, outer_loop_);
            places = chart.vertices;
            chart_factorizations_ = chart.factorizations;
        }
        paths_ = loop_paths(source_, places, outer_loop_);
    }
    map_ = Eigen::VectorXcd::Zero(source_.mesh.vertex_count());
}

std::string PiecewiseSolver::name(std::size_t piece) const {
    return "in the piece of face " + std::to_string(pieces_[piece].faces[0]) + " (" +
           counted(pieces_[piece].faces.size(), "face", "faces") + ", its vertices and loops counted anew)";
}

ExtremalSolver::Update PiecewiseSolver::update(const std::vector<Complex>& images, int max_iterations) {
    if (images.size() != boundary_.images.size())
        throw Error(Cause::bad_boundary, "there are " + std::to_string(images.size()) + " new images for " +
                                             std::to_string(boundary_.images.size()) + " prescribed vertices");
    BoundaryCondition moved = boundary_;
    moved.images = images;
    require_feasible(source_, moved, outer_loop_);
    std::vector<std::vector<Complex>> own(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
        for (const int pin : pieces_[p].pins) own[p].push_back(images[pin]);
        BoundaryCondition part = pieces_[p].boundary;
        part.images = own[p];
        require_feasible(pieces_[p].surface, part, pieces_[p].outer_loop);
    }
    boundary_ = std::move(moved);
    ExtremalSolver::Update result{map_, 0, 0, 0, true};
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
        pieces_[p].boundary.images = own[p];
        const ExtremalSolver::Update part = solvers_[p].update(own[p], max_iterations);
        map_(pieces_[p].vertices) = part.map;
        result.k = std::max(result.k, part.k);
        result.change = std::max(result.change, part.change);
        result.flipped += part.flipped;
        result.converged = result.converged && part.converged;
    }
    return result;
}

ExtremalMap PiecewiseSolver::solve() {
    ExtremalMap whole;
    std::vector<ExtremalMap> parts;
    iterations_before_ = 0;
    for (ExtremalSolver& solver : solvers_) {
        parts.push_back(solver.solve());
        iterations_before_ += parts.back().iterations;
    }
    merge(parts, whole);
    map_ = whole.map;
    return whole;
}

void PiecewiseSolver::merge(std::vector<ExtremalMap>& parts, ExtremalMap& whole) const {
    const Operators& operators = source_.operators;
    whole.map = whole.harmonic = Eigen::VectorXcd::Zero(source_.mesh.vertex_count());
    whole.phi = Eigen::VectorXcd::Zero(operators.sample_count());
    whole.split = prepared_.split;
    whole.factorizations = chart_factorizations_;
    if (prepared_.split) whole.warnings.push_back(prepared_.split_warning("prescribed"));
    std::size_t decisive = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        ExtremalMap& part = parts[p];
        whole.map(pieces_[p].vertices) = part.map;
        whole.harmonic(pieces_[p].vertices) = part.harmonic;
        whole.phi(pieces_[p].samples) = part.phi;
        whole.iterations += part.iterations;
        whole.factorizations += part.factorizations;
        whole.evened = whole.evened || part.evened;
        whole.folds_removed = whole.folds_removed || part.folds_removed;
        whole.pieces.push_back({pieces_[p].faces, part.k, part.K, part.K_lower, part.K_lower_proved, part.termination});
        if (part.termination == Termination::iteration_limit ||
            ((part.termination == Termination::below_bound || part.termination == Termination::unconfirmed) &&
             whole.termination == Termination::converged))
            whole.termination = part.termination;
        if (part.K > parts[decisive].K) decisive = p;
        // Warnings about corners name vertices of the whole.
        const auto of_piece = [&](const Warning& warning) {
            return Warning{warning.kind, name(p) + ": " + warning.sentence,
                           in_whole(warning.where, pieces_[p].vertices, pieces_[p].faces)};
        };
        if (part.sharpest) {
            const BoundaryCorner& corner = *part.sharpest;
            const bool decides = part.termination == Termination::not_teichmuller;
            const std::optional<Warning> own = decides ? std::optional(corner_warning(corner)) : std::nullopt;
            BoundaryCorner moved = corner;
            moved.vertex = pieces_[p].vertices[corner.vertex];
            for (const Warning& warning : part.warnings)
                whole.warnings.push_back(warning == own ? corner_warning(moved) : of_piece(warning));
            if (!whole.sharpest || moved.safe_bound > whole.sharpest->safe_bound) whole.sharpest = moved;
        } else {
            for (const Warning& warning : part.warnings) whole.warnings.push_back(of_piece(warning));
        }
    }
    // Pieces count their loops themselves.
    if (whole.sharpest) {
        whole.sharpest->loop = whole.sharpest->position = -1;
        if (const auto at = boundary_position(source_.topology, whole.sharpest->vertex)) {
            whole.sharpest->loop = at->loop;
            whole.sharpest->position = at->position;
        }
    }
    whole.differential = differential_of_pieces(parts, whole.phi);
    whole.corners = find_corners(source_, boundary_);
    whole.history = std::move(parts[decisive].history);
    whole.distortion = distortion(operators, whole.map);
    const AttainedDilatation attained = attained_dilatation(source_, whole.map, whole.distortion);
    whole.K_max = attained.K;
    record_residual(boundary_, whole);
    if (!paths_.empty()) whole.homotopy = homotopy_class(source_, paths_, whole.map, outer_loop_);
    merge_bounds(parts, whole);
    if (std::isfinite(whole.K_max))
        whole.bounds.push_back({Bound::Kind::attained, whole.K_max, Bound::Of::extremal, attained.rigorous});
    if (whole.termination == Termination::converged && whole.sharpest && corner_decides(*whole.sharpest, whole.K))
        whole.termination = Termination::not_teichmuller;
}

QuadraticDifferential PiecewiseSolver::differential_of_pieces(const std::vector<ExtremalMap>& parts,
                                                              const Eigen::VectorXcd& phi) const {
    QuadraticDifferential whole = differential_of(source_, phi);
    std::vector<int> owner(source_.mesh.vertex_count(), -1);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const std::vector<int>& vertices = pieces_[p].vertices;
        for (const int v : parts[p].differential.poles) whole.poles.push_back(vertices[v]);
        for (const int v : parts[p].differential.jumps) whole.jumps.push_back(vertices[v]);
        for (const int v : vertices) {
            if (owner[v] >= 0) whole.jumps.push_back(v);  // on a curve that cuts
            owner[v] = static_cast<int>(p);
        }
    }
    for (std::vector<int>* list : {&whole.poles, &whole.jumps}) {
        std::sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    return whole;
}

/// Of every kind the largest, for a bound of a piece's map is one of the whole's.
void PiecewiseSolver::merge_bounds(const std::vector<ExtremalMap>& parts, ExtremalMap& whole) const {
    const auto take = [&](Bound::Kind kind, bool rigorous_alone) {
        const Bound* best = nullptr;
        for (const ExtremalMap& part : parts)
            for (const Bound& bound : part.bounds)
                if (bound.kind == kind && (bound.rigorous || !rigorous_alone) && (!best || bound.K > best->K))
                    best = &bound;
        return best;
    };
    const Bound *lower = take(Bound::Kind::reich_strebel, false), *proved = take(Bound::Kind::reich_strebel, true);
    if (lower) whole.bounds.push_back(*lower);
    if (proved && proved != lower) whole.bounds.push_back(*proved);
    using Kind = Bound::Kind;
    for (const Kind kind : {Kind::reich_strebel_estimate, Kind::averaged_estimate, Kind::corner, Kind::edge_corner,
                            Kind::moduli, Kind::pair, Kind::mesh_harmonic})
        if (const Bound* bound = take(kind, false)) whole.bounds.push_back(*bound);
    for (const ExtremalMap& part : parts) {
        whole.K = std::max(whole.K, part.K);
        whole.K_lower = std::max(whole.K_lower, part.K_lower);
        whole.K_lower_proved = std::max(whole.K_lower_proved, part.K_lower_proved);
    }
    whole.k = k_of(whole.K);
}

}  // namespace beltrami
