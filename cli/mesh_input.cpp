#include "mesh_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/read_polygons.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/repair.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/space/polygon_surface.h>

namespace beltrami::cli {

namespace {

MeshInput unmended(LoadedMesh loaded) {
    MeshInput input;
    input.mesh = std::move(loaded.mesh);
    input.attributes = std::move(loaded.attributes);
    input.vertices.resize(static_cast<std::size_t>(input.mesh.vertex_count()));
    input.faces.resize(static_cast<std::size_t>(input.mesh.face_count()));
    std::iota(input.vertices.begin(), input.vertices.end(), 0);
    std::iota(input.faces.begin(), input.faces.end(), 0);
    input.numbers = input.vertices;
    return input;
}

/// Goes over to a mesh made of the present one.
/// @param vertices for each new vertex the present one
/// @param numbers  for each present vertex the new one, or −1
void replace(MeshInput& input, Mesh mesh, const std::vector<int>& vertices, const std::vector<int>& faces,
             const std::vector<int>& numbers) {
    std::vector<std::vector<int>> rows;
    rows.reserve(vertices.size());
    for (const int v : vertices) rows.push_back({v});
    input.attributes = carried(input.attributes, rows, faces);
    input.mesh = std::move(mesh);
    std::vector<int> of_file;
    of_file.reserve(vertices.size());
    for (const int v : vertices) of_file.push_back(input.vertices[v]);
    input.vertices = std::move(of_file);
    std::vector<int> faces_of_file;
    faces_of_file.reserve(faces.size());
    for (const int f : faces) faces_of_file.push_back(input.faces[f]);
    input.faces = std::move(faces_of_file);
    for (int& number : input.numbers) number = number < 0 ? -1 : numbers[number];
}

void keep(MeshInput& input, Submesh part) {
    std::vector<int> numbers(static_cast<std::size_t>(input.mesh.vertex_count()), -1);
    for (std::size_t v = 0; v < part.vertices.size(); ++v) numbers[part.vertices[v]] = static_cast<int>(v);
    replace(input, std::move(part.mesh), part.vertices, part.faces, numbers);
}

/// @throw Error bad_mesh if faces name vertices that do not exist
void require_indices(const Mesh& mesh) {
    for (const int v : mesh.faces.vertices())
        if (v < 0 || v >= mesh.vertex_count()) require_sound(mesh);
}

/// Puts the mesh in place of the one that was read, with a warning of what was cut.
void replace_by(SplitMesh split, const char* one, const char* many, MeshInput& input, Warnings& warnings) {
    if (split.cut.empty()) return;
    warnings.push_back({WarningKind::mended,
                        counted(split.cut.size(), one, many) + " cut into triangles; the first is face " +
                            std::to_string(split.cut[0]),
                        {Things::faces, split.cut}});
    std::vector<int> same(static_cast<std::size_t>(input.mesh.vertex_count()));
    std::iota(same.begin(), same.end(), 0);
    replace(input, std::move(split.mesh), same, split.faces, same);
}

}  // namespace

void cut_folded_quads(MeshInput& input, Warnings& warnings) {
    replace_by(split_unusable_faces(input.mesh), "quad that folds was", "quads that fold were", input, warnings);
}

void cut_folded_polygons(MeshInput& input, Warnings& warnings) {
    require_indices(input.mesh);
    replace_by(split_folded_polygons(input.mesh), "face that is not convex was", "faces that are not convex were",
               input, warnings);
}

void take_split(MeshInput& input, const SplitProblem& split) {
    std::vector<std::vector<int>> rows;
    rows.reserve(input.mesh.vertex_count() + split.parents.size());
    for (int v = 0; v < input.mesh.vertex_count(); ++v) rows.push_back({v});
    for (const std::array<int, 4>& parents : split.parents) {
        rows.emplace_back();
        for (const int parent : parents)
            if (parent >= 0) rows.back().push_back(parent);
    }
    input.attributes = carried(input.attributes, rows, split.face_parents);
    input.mesh = split.mesh;
    input.vertices.resize(rows.size(), -1);
    std::vector<int> faces;
    faces.reserve(split.face_parents.size());
    for (const int f : split.face_parents) faces.push_back(input.faces[f]);
    input.faces = std::move(faces);
}

void cut_into_triangles(MeshInput& input, Warnings& warnings) {
    replace_by(split_into_triangles(input.mesh), "face was", "faces were", input, warnings);
}

double unit_of(double size) {
    if (!(size > 0) || !std::isfinite(size) || (size > 1e-60 && size < 1e60)) return 1;
    return std::exp2(std::round(std::log2(size)));
}

int MeshInput::number_of(int file_vertex, const std::string& what) const {
    if (file_vertex < 0 || file_vertex >= static_cast<int>(numbers.size()))
        throw Error(Cause::bad_boundary,
                    fmt::format("vertex {}, {}, does not exist: the file has the vertices 0 to {}", file_vertex, what,
                                numbers.size() - 1),
                    "vertices are counted from 0, as the file has them", {Things::vertices, {file_vertex}});
    if (numbers[file_vertex] < 0)
        throw Error(Cause::bad_boundary,
                    fmt::format("vertex {}, {}, is not in the part of the mesh that is kept", file_vertex, what),
                    "name another one", {Things::vertices, {file_vertex}});
    return numbers[file_vertex];
}

void MeshInputOptions::add_to(CLI::App& app) {
    app.add_option("--weld", weld_, "make vertices one that are no further apart than TOL, in the units of the file")
        ->check(CLI::NonNegativeNumber)
        ->type_name("TOL");
    app.add_flag("--orient", orient_, "turn the faces that are oriented against their neighbours");
    app.add_flag("--keep-largest", keep_largest_, "keep only the component with the most faces");
    app.add_flag("--drop-unreferenced", drop_unreferenced_,
                 "leave out vertices without faces. Options, files and marks count the vertices as the file has "
                 "them; messages and OUT as they are after this, --keep-largest and --weld");
}

MeshInput MeshInputOptions::load(const std::string& path, Warnings& warnings) const {
    LoadedMesh loaded = read_mesh(path);
    append(warnings, loaded.warnings);
    return mend(std::move(loaded), warnings);
}

MeshInput MeshInputOptions::load_polygons(const std::string& path, Warnings& warnings) const {
    LoadedMesh loaded = read_polygons(path);
    append(warnings, loaded.warnings);
    return mend(std::move(loaded), warnings);
}

MeshInput MeshInputOptions::mend(LoadedMesh loaded, Warnings& warnings) const {
    MeshInput input = unmended(std::move(loaded));
    if (weld_ || orient_ || keep_largest_ || drop_unreferenced_) {
        require_indices(input.mesh);
        input.file_faces = input.mesh.faces;
    }
    if (weld_) {
        const int before = input.mesh.vertex_count();
        WeldedMesh welded = weld(input.mesh, *weld_);
        warnings.push_back(
            {WarningKind::mended,
             fmt::format(
                 "{} welded to {}{}", counted(before, "vertex was", "vertices were"), welded.mesh.vertex_count(),
                 welded.removed_faces > 0 ? ", and " + counted(welded.removed_faces, "face", "faces") + " went" : "")});
        replace(input, std::move(welded.mesh), welded.vertices, welded.faces, welded.welded);
    }
    if (orient_) {
        OrientedMesh oriented = orient(input.mesh);
        if (!oriented.turned.empty())
            warnings.push_back({WarningKind::mended,
                                counted(oriented.turned.size(), "face was", "faces were") +
                                    " turned to agree with its "
                                    "neighbours, the first is face " +
                                    std::to_string(oriented.turned[0]),
                                {Things::faces, oriented.turned}});
        input.mesh = std::move(oriented.mesh);
    }
    if (keep_largest_) {
        const int before = input.mesh.face_count();
        keep(input, largest_component(input.mesh));
        if (input.mesh.face_count() < before)
            warnings.push_back(
                {WarningKind::mended, fmt::format("the largest component, of {}, was kept of {}",
                                                  counted(input.mesh.face_count(), "face", "faces"), before)});
    }
    if (drop_unreferenced_) {
        const int before = input.mesh.vertex_count();
        keep(input, remove_unreferenced(input.mesh));
        if (input.mesh.vertex_count() < before)
            warnings.push_back(
                {WarningKind::mended, counted(before - input.mesh.vertex_count(), "vertex without faces was",
                                              "vertices without faces were") +
                                          " left out"});
    }
    if (input.mesh.vertex_count() > 0 && input.mesh.positions.allFinite()) {
        const Eigen::RowVectorXd low = input.mesh.positions.colwise().minCoeff(),
                                 high = input.mesh.positions.colwise().maxCoeff();
        input.unit = unit_of((high - low).maxCoeff());
        if (input.unit != 1) input.mesh.positions /= input.unit;
    }
    return input;
}

std::string MeshInputOptions::hint(const Error& error, const std::string& path) const {
    return error.cause() == Cause::bad_mesh ? hint(path) : cli::hint(error);
}

std::string MeshInputOptions::hint(const std::string& path) const {
    Warnings ignored;
    const MeshInput input = load(path, ignored);
    for (const Finding& finding : diagnose(input.mesh)) {
        if (finding.defect == Defect::inconsistent_orientation && !orient_) return "--orient turns these faces";
        if (finding.defect != Defect::several_components) continue;
        if (!weld_)
            if (const WeldSuggestion found = suggest_weld(input.mesh); found.tolerance > 0)
                return fmt::format("--weld {:.2g} makes vertices at one place one, and leaves {}",
                                   1.05 * input.unit * found.tolerance,
                                   counted(found.components, "component", "components"));
        return std::string("--keep-largest keeps the component with the most faces") +
               (each_component_ ? ", --each-component maps each by itself" : "");
    }
    return {};
}

}  // namespace beltrami::cli
