#include "start_map_option.h"

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/texture_map.h>

#include "command.h"

namespace beltrami::cli {

void StartMapOption::add_to(CLI::App& app, const std::string& also) {
    app.add_option(
           "--start-map", path_,
           "begin with the map that this mesh has as its vt, folded or not: SOURCE's vertices and faces in their "
           "order, as OUT has them; one whose end is folded is given up, with a warning" +
               also)
        ->type_name("FILE");
}

Mesh load_of_same_faces(const std::string& option, const std::string& path, const Mesh& source, Warnings& warnings) {
    Mesh start = cli::load(path, warnings);
    const std::string other = option + " " + path + " is another mesh than SOURCE: ",
                      next = "give a map of the same vertices and faces, in the same order";
    if (start.vertex_count() != source.vertex_count())
        throw Error(Cause::bad_mesh,
                    other + "it has " + counted(start.vertex_count(), "vertex", "vertices") + ", SOURCE " +
                        std::to_string(source.vertex_count()),
                    next);
    if (start.face_count() != source.face_count())
        throw Error(Cause::bad_mesh,
                    other + "it has " + counted(start.face_count(), "face", "faces") + ", SOURCE " +
                        std::to_string(source.face_count()),
                    next);
    for (int f = 0; f < source.face_count(); ++f) {
        const auto a = start.faces[f], b = source.faces[f];
        if (!std::equal(a.begin(), a.end(), b.begin(), b.end()))
            throw Error(Cause::bad_mesh, other + "face " + std::to_string(f) + " has other vertices", next,
                        {Things::faces, {f}});
    }
    return start;
}

std::optional<Eigen::VectorXcd> StartMapOption::load(const Mesh& source, Warnings& warnings) const {
    if (!given()) return {};
    const Mesh start = load_of_same_faces("--start-map", path_, source, warnings);
    try {
        return texture_map(start);
    } catch (const Error& error) {
        throw Error(error.cause(), "--start-map " + path_ + ": " + error.what(), {}, error.where());
    }
}

}  // namespace beltrami::cli
