#include <beltrami/base/where.h>

namespace beltrami {

const char* to_string(Things things) {
    switch (things) {
        case Things::none:
            return "none";
        case Things::vertices:
            return "vertices";
        case Things::edges:
            return "edges";
        case Things::faces:
            return "faces";
        case Things::loops:
            return "loops";
        case Things::curves:
            return "curves";
        case Things::points:
            return "points";
        case Things::samples:
            return "samples";
        case Things::lines:
            return "lines";
        case Things::shapes:
            return "shapes";
        case Things::unknowns:
            return "unknowns";
    }
    return "none";
}

Where in_whole(Where where, const std::vector<int>& vertices, const std::vector<int>& faces) {
    const bool of_vertices = where.of == Things::vertices || where.of == Things::edges;
    if (!of_vertices && where.of != Things::faces) return {};
    const std::vector<int>& whole = of_vertices ? vertices : faces;
    for (int& index : where.indices) {
        if (index >= static_cast<int>(whole.size())) return {};
        index = whole[index];
    }
    return where;
}

}  // namespace beltrami
