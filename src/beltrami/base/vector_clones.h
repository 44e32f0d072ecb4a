#pragma once

/// Before a function: compiled for the vector units of several processors, of which the one at hand is chosen when the
/// program starts.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BELTRAMI_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BELTRAMI_VECTOR_CLONES
#endif
