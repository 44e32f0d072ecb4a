#pragma once

#include <filesystem>

#include <Eigen/Core>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Reads a Beltrami coefficient, one number a face: a PLY with the face properties mu_re and mu_im, as write_mesh
/// writes them, or a text of lines `face re im`, each face once, in any order.
/// @param face_count of the mesh to which it belongs
/// @return #F
/// @throw Error unreadable if the file cannot be read, has another number of faces, leaves one out or names it twice,
///        or where |μ| < 1 does not hold
Eigen::VectorXcd read_coefficient(const std::filesystem::path& path, int face_count);

}  // namespace beltrami
