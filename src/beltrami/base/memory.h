#pragma once

#include <cstddef>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Bytes for each face of a mesh that its extremal map takes at least.
inline constexpr std::size_t kMemoryPerFace = 1200;

/// For programs, not for libraries, as it is about all memory of the process: what is freed stays with it for what asks
/// next, and so much is made ready in one go, as far as half of what is free allows. Where the system hands out pages
/// one by one as they are first touched, that can cost as much as the work done in them. Does nothing but with the GNU
/// C library on Linux.
void ready_memory(std::size_t bytes);

}  // namespace beltrami
