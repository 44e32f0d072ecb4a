#pragma once

#include <cstddef>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Bytes for each face of a mesh that its extremal map takes at least; and for each of the first 10⁴ faces more, for
/// what does not grow with the mesh.
inline constexpr std::size_t kMemoryPerFace = 1200, kMoreOfFirstFaces = 1600, kFirstFaces = 10'000;

/// Bytes that the extremal map of a mesh takes, about.
inline constexpr std::size_t memory_of_map(int faces) {
    const auto count = static_cast<std::size_t>(faces);
    return kMemoryPerFace * count + kMoreOfFirstFaces * (count < kFirstFaces ? count : kFirstFaces);
}

/// For programs, not for libraries, as it is about all memory of the process: what is freed stays with it for what asks
/// next, and so much is made ready in one go, as far as half of what is free allows.
/// Where the system hands out pages one by one as they are first touched, that can cost as much as the work done in
/// them. Does nothing but with the GNU C library on Linux.
void ready_memory(std::size_t bytes);

/// The same on a thread of its own, beside what the program does next, unless thread_count() is 1.
void ready_memory_beside(std::size_t bytes);

}  // namespace beltrami
