#pragma once

#include <optional>
#include <string>

#include <beltrami/base/public.h>
#include <beltrami/remeshing/mesh_comparison.h>

namespace beltrami BELTRAMI_PUBLIC {

struct RemeshedSurface;

/// A mesh whose vertices have moved along itself.
struct RemeshRecord {
    std::string reference, method;  ///< of shapes; "barrier", "linear", "normals", "area"
    double power = 0;               ///< of the barrier
    AngleStatistics before, after;
    SurfaceDistance distance;  ///< of image and surface, of the diagonal
    double area_ratio = 1;
    double size_deviation = 0;  ///< standard deviation of log(area after/before) of the faces
    int opposed_before = 0, opposed_after = 0;
    double valence_floor = 0;            ///< mean over the vertices of the |μ| that their valences cost
    std::optional<double> teichmueller;  ///< of tori: k* of surface and reference
    int steps = 0;
    bool settled = false;
};

/// What can be measured of a mesh and the same with its vertices moved; the reference, the method, its power and what
/// connectivity forbids are the caller's.
RemeshRecord remesh_record(const Mesh& mesh, const Mesh& image, const RemeshedSurface& result);

}  // namespace beltrami
