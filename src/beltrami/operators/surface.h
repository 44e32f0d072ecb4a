#pragma once

#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/operators.h>

namespace beltrami {

/// A mesh that passed the diagnosis, with its topology and the operators of its metric: what every solver starts from.
struct Surface {
    Mesh mesh;
    std::vector<Finding> findings;  ///< warnings of the diagnosis
    Topology topology;
    Operators operators;  ///< of the mesh's own metric unless another was given
    bool planar_metric;   ///< operators are in the frame of the plane that the mesh lies in

    /// With the metric of the mesh itself.
    /// @throw Error bad_mesh
    explicit Surface(Mesh mesh);
    /// With a metric of its own, e.g. operators_from_lengths.
    Surface(Mesh mesh, Operators metric);
};

}  // namespace beltrami
