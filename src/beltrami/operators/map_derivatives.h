#pragma once

#include <beltrami/base/public.h>
#include <beltrami/operators/operators.h>

namespace beltrami BELTRAMI_PUBLIC {

/// All that anybody reads of a map: its derivatives at the samples, in an oriented frame of the image, and the size of
/// the image.
struct MapDerivatives {
    Eigen::VectorXcd dz, dzbar;  ///< #S ∂f, ∂̄f
    double image_diameter = 0;   ///< of the box around the image
};

/// Of a map to the plane given at the vertices (#V).
MapDerivatives derivatives(const Operators& source, const Eigen::VectorXcd& map);

/// Of a map into space (#V×3), each sample in an orthonormal frame of its image. Orientation is judged against the
/// image's own area-weighted vertex normals: where the image opposes them, |∂̄f| > |∂f|.
/// @param normals #V×3 vertex normals of the image (vertex_normals of the image mesh)
MapDerivatives derivatives(const Operators& source, const Positions& image, const Positions& normals);

}  // namespace beltrami
