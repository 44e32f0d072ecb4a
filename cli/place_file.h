#pragma once

#include <span>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami::cli {

/// @throw Error unreadable "path:line: what", or of another cause
[[noreturn]] void fail_at_row(const std::string& path, const NumberRow& row, const std::string& what,
                              Cause cause = Cause::unreadable, const std::string& next_step = "repair the line");

/// The place "face b0 b1 b2" or, on a quad, "face b0 b1 b2 b3", one of the weights 0.
/// @throw Error unreadable
MeshPoint place_of_row(const std::string& path, const NumberRow& row, const Mesh& mesh);

/// The same as a line.
std::string line_of_place(const Mesh& mesh, const MeshPoint& place);

/// A file of places, one for every vertex of a mesh.
/// @param count of the vertices
/// @throw Error unreadable
std::vector<MeshPoint> read_places(const std::string& path, const Mesh& mesh, int count);
void write_places(const std::string& path, const Mesh& mesh, std::span<const MeshPoint> places);

}  // namespace beltrami::cli
