#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/constraints/constraints.h>
#include <beltrami/locate/planar_locator.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// Writes places on a mesh, a line each.
void write_places(const std::string& path, const std::vector<MeshPoint>& places);

/// --onto, --loops, --match, --marks, --mark-vertices, --correspondence, --places: a target onto which the boundary
/// slides, or a mesh on whose boundary it is prescribed.
class OntoTarget {
  public:
    enum class Kinds { prescribed_too, meshes_and_domains, domains };
    /// --correspondence only where what slides may be prescribed too; --mark-vertices and --places not for domains.
    void add_to(CLI::App& app, Kinds kinds = Kinds::meshes_and_domains);
    bool given() const { return !path_.empty(); }
    /// Whether an option that belongs to --onto was given; its name.
    std::string stray() const;
    /// Whether the boundary is prescribed on that of a mesh.
    bool prescribes() const { return !correspondence_file_.empty(); }
    /// Pairs of --correspondence. @pre load()
    const std::vector<std::array<int, 2>>& correspondence() const { return correspondence_; }
    /// Whether pairs of loops or a way to find them are asked for.
    bool pairs_loops() const { return !pair_specs_.empty() || match_ != "position"; }
    bool has_marks() const { return !marks_file_.empty() || !mark_vertices_file_.empty(); }
    std::vector<NamedFile> inputs() const;
    std::vector<NamedFile> outputs() const { return {{"--places", places_}}; }
    const std::string& path() const { return path_; }
    const std::string& places_file() const { return places_; }

    /// Reads the target and the options' files. The reader's warnings are added.
    /// @throw Error unreadable, bad_option, bad_boundary
    void load(const MeshInput& source, Warnings& warnings);
    /// One of them is there. @pre load()
    const std::optional<TargetDomain>& domain() const { return domain_; }
    const std::optional<Surface>& surface() const { return surface_; }
    /// Pairs and marks into what is wanted. @pre load()
    void apply(Correspondence& wanted) const;
    /// The target too. @pre load()
    void apply(Constraints& constraints) const;
    /// Writes --places, if it is wanted.
    void write_places(const std::vector<MeshPoint>& places) const;

  private:
    void read_marks(const MeshInput& input, Warnings& warnings);

    Kinds kinds_ = Kinds::meshes_and_domains;

    std::string path_, match_ = "position", marks_file_, mark_vertices_file_, correspondence_file_, places_;
    std::vector<std::string> pair_specs_;
    std::optional<TargetDomain> domain_;
    std::optional<Surface> surface_;
    std::vector<std::array<int, 2>> pairs_, mark_vertices_, correspondence_;
    struct PlaceMark {
        int vertex;
        Complex place;
    };
    std::vector<PlaceMark> marks_;
};

}  // namespace beltrami::cli
