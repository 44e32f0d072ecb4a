#pragma once

#include <optional>

#include <beltrami/base/public.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/operators.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh that passed the diagnosis, with its topology and the operators of its metric: what every solver starts from.
struct Surface {
    Mesh mesh;
    std::vector<Finding> findings;  ///< warnings of the diagnosis
    Topology topology;
    /// A metric of its own: one point per face corner, every face has the shape of its points (#corners×2 or ×3).
    std::optional<Positions> metric;
    Operators operators;  ///< of the metric, or of the mesh itself
    /// Lengths, in the metric, of the edges of topology.boundary_loops: [l][i] from vertex i of loop l to the next.
    std::vector<std::vector<double>> boundary_edge_lengths;

    /// With the metric of the mesh itself.
    /// @throw Error bad_mesh
    explicit Surface(Mesh mesh);
    /// With a metric of its own, for instance corners_from_lengths or texture_corners.
    /// @throw Error bad_mesh
    Surface(Mesh mesh, Positions metric);

    /// The exact holomorphic coordinate that a surface in the plane has, in whose frame its operators are: x + iy of
    /// every vertex, seen from the side from which the faces run counter-clockwise (#V). Null where the mesh does not
    /// lie in a plane z = const or has a metric of its own.
    const Eigen::VectorXcd* coordinate() const { return coordinate_ ? &*coordinate_ : nullptr; }
    bool in_plane() const { return coordinate_.has_value(); }

  private:
    std::optional<Eigen::VectorXcd> coordinate_;
};

/// The surface with the metric, or with that of the mesh itself.
/// @throw Error bad_mesh
Surface surface_of(Mesh mesh, std::optional<Positions> metric);

/// @throw Error bad_mesh unless the surface is a disk: one component, one boundary loop, genus 0
void require_disk(const Surface& surface);

/// @throw Error bad_mesh unless the surface has one component and a boundary, whatever its genus
void require_open_component(const Surface& surface);

/// @throw Error bad_mesh unless the surface has one component, genus 0 and a boundary
void require_genus_zero(const Surface& surface);

}  // namespace beltrami
