#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What can be wrong with a mesh.
enum class Defect {
    empty,
    not_finite,
    index_out_of_range,
    too_many_corners,  ///< faces with more than 4 (or fewer than 3) corners
    unreferenced_vertex,
    several_components,
    non_manifold_edge,
    non_manifold_vertex,
    inconsistent_orientation,  ///< neighbouring faces disagree; a coherent orientation exists
    not_orientable,            ///< no coherent orientation exists (Möbius)
    duplicate_face,
    degenerate_face,  ///< a face that names a vertex twice
    zero_area_face,
    sliver_face,
    folded_planar_face,  ///< planar mesh with faces of both orientations
    reflex_quad,         ///< a quad with a reflex corner: the bilinear map of a square onto it folds
};

/// One finding: what, where, what next.
struct Finding {
    Defect defect;
    bool fatal;            ///< true: no map can be computed before it is mended; false: a warning
    std::string sentence;  ///< plain words, without a final full stop
    std::string next_step;
    std::vector<int> indices;  ///< vertices, edges as vertex pairs or faces, as the sentence says; counted from 0

    Where where() const;
};

/// True of the defects with which edges, loops and genus are not defined.
bool spoils_topology(Defect defect);

/// Examines a mesh completely; no input makes it fail. Fatal findings come first.
std::vector<Finding> diagnose(const Mesh& mesh);

/// @throw Error bad_mesh naming the first fatal finding (and the number of further ones).
/// @return the findings that are only warnings.
std::vector<Finding> require_sound(const Mesh& mesh);

}  // namespace beltrami
