#include <beltrami/hyperbolic/cut_marking.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/hyperbolic/target_edges.h>

namespace beltrami {

namespace {

using Word = std::vector<Letter>;

Letter inverse(const Letter& letter) {
    return {letter.generator, !letter.inverse};
}

/// t A r B t⁻¹ C r⁻¹ D is [a, b] A D C B with a = (C B)⁻¹ t and b = A r B.
struct Handle {
    Letter t, r;
    Word A, B, C;
};

/// Handle after handle; of all pairs that with the shortest words first, or the words grow exponentially.
std::vector<Handle> handles_of(Word word) {
    std::vector<Handle> result;
    while (!word.empty()) {
        std::size_t least = std::numeric_limits<std::size_t>::max();
        Handle best;
        Word rest;
        for (std::size_t turn = 0; turn < word.size(); ++turn) {
            Word w = word;
            std::rotate(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(turn), w.end());
            const auto end = std::find(w.begin() + 1, w.end(), inverse(w[0]));
            for (auto r = w.begin() + 1; r < end; ++r) {
                const auto other = std::find(end + 1, w.end(), inverse(*r));
                if (other == w.end()) continue;
                Handle handle{w[0], *r, {w.begin() + 1, r}, {r + 1, end}, {end + 1, other}};
                const std::size_t cost = handle.A.size() + 2 * handle.B.size() + handle.C.size();
                if (cost >= least) continue;
                least = cost;
                rest = handle.A;
                rest.insert(rest.end(), other + 1, w.end());
                rest.insert(rest.end(), handle.C.begin(), handle.C.end());
                rest.insert(rest.end(), handle.B.begin(), handle.B.end());
                best = std::move(handle);
            }
        }
        if (least == std::numeric_limits<std::size_t>::max()) break;  // not a word of a closed surface
        result.push_back(std::move(best));
        word = std::move(rest);
    }
    return result;
}

MarkedStep value(const Word& word, const std::vector<MarkedStep>& of, const MarkedStep& nowhere) {
    MarkedStep result = nowhere;
    for (const Letter& letter : word) {
        const MarkedStep& step = of[static_cast<std::size_t>(letter.generator)];
        result = result * (letter.inverse ? step.inverse() : step);
    }
    return result;
}

Word joined(const Word& a, const Word& b) {
    Word result = a;
    result.insert(result.end(), b.begin(), b.end());
    return result;
}

/// The canonical generators of the target, in the frame of the root.
std::vector<std::pair<MarkedStep, MarkedStep>> canonical_pairs(const EdgeGroup& target,
                                                               const std::vector<double>& lengths, int root) {
    const CutTree tree = short_cut_tree(target.triangulation, lengths, root);
    const detail::TargetEdges edges(target);
    std::vector<MarkedStep> generators;
    for (const std::vector<int>& path : generator_paths(target.triangulation, tree)) {
        MarkedStep around = edges.nowhere();
        for (std::size_t i = 0; i < path.size(); ++i)
            around = around * edges.along(edges.halfedge(path[i], path[(i + 1) % path.size()]));
        generators.push_back(around);
    }
    std::vector<std::pair<MarkedStep, MarkedStep>> result;
    for (const Handle& handle : handles_of(boundary_word(target.triangulation, tree)))
        result.emplace_back(value(joined(handle.C, handle.B), generators, edges.nowhere()).inverse() *
                                value({handle.t}, generators, edges.nowhere()),
                            value(joined(joined(handle.A, {handle.r}), handle.B), generators, edges.nowhere()));
    return result;
}

}  // namespace

Marking marking_by_cutting(const Surface& source, const IntrinsicTriangulation& triangulation,
                           const std::vector<double>& source_lengths, int source_root, const EdgeGroup& target,
                           const std::vector<double>& target_lengths, int target_root) {
    require_triangles(source);
    const std::vector<std::pair<MarkedStep, MarkedStep>> pairs = canonical_pairs(target, target_lengths, target_root);
    const CutTree tree = short_cut_tree(triangulation, source_lengths, source_root);
    const std::vector<Handle> handles = handles_of(boundary_word(triangulation, tree));
    if (handles.size() != pairs.size() || tree.generators.size() != 2 * handles.size())
        throw Error(Cause::bad_mesh, "the surfaces are not closed surfaces of one genus", "take such");
    const MarkedStep nowhere{{}, Eigen::RowVectorXi::Zero(target.homology.size())};
    std::vector<MarkedStep> values(tree.generators.size(), nowhere);
    const auto set = [&](const Letter& letter, const MarkedStep& step) {
        values[static_cast<std::size_t>(letter.generator)] = letter.inverse ? step.inverse() : step;
    };
    // What is left of the word after a handle was taken is known first.
    for (std::size_t i = handles.size(); i-- > 0;) {
        const Handle& handle = handles[i];
        const auto& [a, b] = pairs[i];
        set(handle.t, value(joined(handle.C, handle.B), values, nowhere) * a);
        set(handle.r, value(handle.A, values, nowhere).inverse() * b * value(handle.B, values, nowhere).inverse());
    }
    std::vector<MarkedStep> steps(static_cast<std::size_t>(triangulation.halfedge_count()), nowhere);
    for (std::size_t j = 0; j < values.size(); ++j) {
        const int h = tree.generators[j];
        steps[h] = values[j];
        steps[triangulation.twin(h)] = values[j].inverse();
    }
    Marking marking;
    marking.defect = fill_by_flatness(triangulation, tree, steps);
    marking.map.steps.resize(static_cast<std::size_t>(source.topology.edge_count()));
    marking.map.classes = Eigen::MatrixXi::Zero(source.topology.edge_count(), target.homology.size());
    marking.map.bases.assign(static_cast<std::size_t>(source.mesh.vertex_count()), target_root);
    marking.map.frames.resize(marking.map.bases.size());
    set_halfedge_steps(source, steps, marking.map);
    return marking;
}

}  // namespace beltrami
