#pragma once

#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {

/// The half-edges after and before another one in its triangle.
inline int next_halfedge(int h) {
    return IntrinsicTriangulation::next(h);
}
inline int previous_halfedge(int h) {
    return IntrinsicTriangulation::previous(h);
}

}  // namespace beltrami
