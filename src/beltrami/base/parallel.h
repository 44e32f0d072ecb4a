#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Sets how many threads parallel_for may use. Results do not depend on it, to the last bit.
/// @throw Error bad_option if @p count < 1
void set_thread_count(int count);

/// Threads that parallel_for uses; the number of processors unless set_thread_count was called.
int thread_count();

/// Items a chunk holds unless the caller says otherwise.
inline constexpr int kDefaultGrain = 4096;

/// Calls body(first, last) for consecutive chunks [first, last) that cover begin … end-1. The chunks depend on the
/// range and on @p grain only, never on the number of threads. Nested calls, and calls while another thread of the
/// program uses the pool, run serially. The exception of the earliest failing chunk is thrown again here.
/// @param grain items per chunk (the last one may be smaller), at least 1; make it small where an item is costly
/// @pre chunks write to different places
void parallel_for(int begin, int end, const std::function<void(int, int)>& body, int grain = kDefaultGrain);

/// Calls body(i) for i = 0 … n-1, each a chunk of its own: for few items that are costly. See parallel_for.
inline void parallel_for_each(int n, const std::function<void(int)>& body) {
    parallel_for(
        0, n,
        [&](int first, int last) {
            for (int i = first; i < last; ++i) body(i);
        },
        1);
}

/// zero + Σ body(first, last) over the chunks of 0 … n-1, added in the order of the chunks: the same bytes for any
/// number of threads.
/// @param body (int first, int last) → T, the sum over one chunk
template <class T, class Body>
T parallel_sum(int n, const T& zero, const Body& body, int grain = kDefaultGrain) {
    grain = std::max(grain, 1);
    // A wrapper, because elements of std::vector<bool> must not be written concurrently.
    struct Part {
        T value;
    };
    std::vector<Part> parts(n > 0 ? static_cast<std::size_t>((n - 1) / grain) + 1 : 0, Part{zero});
    parallel_for(
        0, n, [&](int first, int last) { parts[first / grain].value = body(first, last); }, grain);
    T sum = zero;
    for (const Part& part : parts) sum += part.value;
    return sum;
}

}  // namespace beltrami
