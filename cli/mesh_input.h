#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/io/read_mesh.h>

#include "hints.h"

namespace beltrami::cli {

/// A mesh with what its file says beside it, mended as MeshInputOptions want it.
struct MeshInput {
    Mesh mesh;
    FileAttributes attributes;
    std::vector<int> vertices;           ///< for each vertex that of the file, of those welded the first
    std::vector<int> faces;              ///< for each face that of the file
    std::vector<int> numbers;            ///< for each vertex of the file its number now; −1: it is gone
    std::optional<FaceList> file_faces;  ///< those of the file, where something was to be mended
    /// Positions are in this unit, a power of two: 1 unless the file's numbers are so large or small that areas and
    /// their squares would leave the range of doubles.
    double unit = 1;

    /// The number of a vertex that is named as the file counts.
    /// @param what it is, for the error: "a pinned vertex"
    /// @throw Error bad_boundary if the file has no such vertex, or it is gone
    int number_of(int file_vertex, const std::string& what) const;
};

/// Cuts the faces that no map can be measured on as they are, quads that fold, into triangles, with a warning.
void cut_folded_quads(MeshInput& input, Warnings& warnings);
/// Cuts all faces that are not triangles into such, with a warning.
void cut_into_triangles(MeshInput& input, Warnings& warnings);

/// The mesh with edges split, its attributes carried along.
void take_split(MeshInput& input, const SplitProblem& split);

/// The same of polygons that are not convex at a corner, where polygons are kept.
void cut_folded_polygons(MeshInput& input, Warnings& warnings);

/// --weld, --orient, --keep-largest, --drop-unreferenced: what is to be mended of a mesh before anything else.
class MeshInputOptions {
  public:
    void add_to(CLI::App& app);
    /// Reads a mesh and mends it, in the order above; what was done is said in a warning.
    /// @throw Error unreadable, bad_mesh
    MeshInput load(const std::string& path, Warnings& warnings) const;
    /// The same with faces of more than four corners as they are.
    MeshInput load_polygons(const std::string& path, Warnings& warnings) const;
    /// The same of a mesh that has been read.
    MeshInput mend(LoadedMesh loaded, Warnings& warnings) const;
    /// Which of these options would help a mesh that cannot be mapped; empty if none would.
    std::string hint(const std::string& path) const;
    /// The same after an error about the mesh; after others what cli::hint() says.
    std::string hint(const Error& error, const std::string& path) const;
    /// The command can map the components one by one.
    void allow_each_component() { each_component_ = true; }

  private:
    std::optional<double> weld_;
    bool orient_ = false, keep_largest_ = false, drop_unreferenced_ = false, each_component_ = false;
};

/// The unit of some coordinates or lengths whose largest is @p size: a power of two near it where their fourth powers
/// would leave the range of doubles, else 1.
double unit_of(double size);

}  // namespace beltrami::cli
