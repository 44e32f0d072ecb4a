#include <beltrami/base/effort.h>

#include <array>
#include <atomic>

namespace beltrami {

namespace {

std::atomic<std::int64_t>& counter(Work work) {
    static std::array<std::atomic<std::int64_t>, 3> counters{};
    return counters[static_cast<std::size_t>(work)];
}

}  // namespace

std::int64_t effort(Work work) {
    return counter(work).load(std::memory_order_relaxed);
}

void count(Work work) {
    counter(work).fetch_add(1, std::memory_order_relaxed);
}

}  // namespace beltrami
