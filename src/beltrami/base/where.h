#pragma once

#include <vector>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What numbers count.
enum class Things {
    none,
    vertices,
    edges,  ///< as pairs of vertices
    faces,
    loops,     ///< boundary loops
    curves,    ///< of a domain in the plane, as the sentence counts them
    points,    ///< of a list that was given, or its segments
    samples,   ///< of a discretisation
    lines,     ///< of a file
    shapes,    ///< of those to be compared
    unknowns,  ///< rows of a linear system
};
const char* to_string(Things things);

/// Places: what is meant, and which ones.
struct Where {
    Things of = Things::none;
    std::vector<int> indices = {};  ///< counted from 0

    friend bool operator==(const Where&, const Where&) = default;
};

/// Places in a part of a mesh in the numbers of the whole; nothing of what has none there, or other parts.
/// @param vertices,faces of the whole, for each of the part
Where in_whole(Where where, const std::vector<int>& vertices, const std::vector<int>& faces);

}  // namespace beltrami
