#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/io/file_attributes.h>
#include <beltrami/operators/distortion.h>

namespace beltrami::cli {

/// @throw Error bad_option if the extension of -o's file is that of no format
void require_mesh_format(const std::string& path);

/// Writes faces with their vertices at positions and, in PLY, μ per face.
void write_at(const std::string& path, const FaceList& faces, const Positions& positions, const Distortion& distortion,
              const FileAttributes& attributes);

/// The same of a mesh with texture coordinates of its own, which are written where the format has them per corner.
void write_with_texture(const std::string& path, const Mesh& mesh, double unit, const Distortion& distortion,
                        const FileAttributes& attributes);

/// --fit: the size of texture coordinates that are written.
class FitOption {
  public:
    void add_to(CLI::App& app);
    /// The points moved and scaled uniformly into the unit square, if that is wanted.
    Positions fitted(const Positions& points) const;

  private:
    std::string fit_ = "none";
};

/// -o OUT, --as-positions and --fit: where and how a planar map of a mesh is written.
class OutputOptions {
  public:
    void add_to(CLI::App& app);
    const std::string& path() const { return path_; }
    /// @throw Error bad_option if the extension is that of no format
    void check() const;
    /// Vertices and faces of the source in their order, with the map as vt (or as positions) and, in PLY, μ per face.
    /// @param attributes of the source's file
    /// @param unit       of the source's positions
    void write(const Mesh& source, const Eigen::VectorXcd& map, const Distortion& distortion,
               const FileAttributes& attributes = {}, double unit = 1) const;
    /// The same for a map onto a surface: vertices stand at their images there, with the plane map as vt.
    void write(const Mesh& source, const Positions& images, const Eigen::VectorXcd& map, const Distortion& distortion,
               const FileAttributes& attributes = {}) const;
    /// The same for a map to the sphere: as positions, or as vt per face corner in a pair of stereographic charts.
    /// @param points #V×3
    void write_sphere(const Mesh& source, const Positions& points, const Distortion& distortion,
                      const FileAttributes& attributes, double unit) const;
    /// The same for a map with seams, as vt per face corner.
    void write_layout(const Mesh& source, TextureCoordinates layout, const Distortion& distortion,
                      const FileAttributes& attributes, double unit) const;
    /// @throw Error bad_option if OUT's format cannot hold a map with seams and is to
    void check_seams() const;
    /// @throw Error bad_option if vertices are to stand at their images and have several
    void check_layout() const;

  private:
    std::string path_;
    bool as_positions_ = false;
    FitOption fit_;
};

}  // namespace beltrami::cli
