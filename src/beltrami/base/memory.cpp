#include <beltrami/base/memory.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>

#include <beltrami/base/parallel.h>

#if defined(__GLIBC__) && defined(__linux__)
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace beltrami {

#if defined(__GLIBC__) && defined(__linux__)

namespace {

/// The heap grows by so much more than it has to.
constexpr int kPad = 1 << 20;
#ifdef MADV_POPULATE_WRITE
constexpr int kPopulate = MADV_POPULATE_WRITE;
#else
constexpr int kPopulate = 23;  // Linux 5.14; older ones refuse it, and nothing is lost
#endif

/// So much is made ready at a time: whoever asks the system for memory meanwhile waits no longer than that.
constexpr std::size_t kAtOnce = std::size_t{8} << 20;

/// Whole pages.
struct Pages {
    char* first = nullptr;
    std::size_t bytes = 0;
};

/// Pages of the memory that is asked for next.
Pages pages_ahead(std::size_t bytes) {
    static std::once_flag once;
    std::call_once(once, [] {
        mallopt(M_MMAP_MAX, 0);  // pages that are mapped one by one are given back when they are freed
        mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
        mallopt(M_TOP_PAD, kPad);
        mallopt(M_ARENA_MAX, 1);
    });
    const long page_size = sysconf(_SC_PAGESIZE), free_pages = sysconf(_SC_AVPHYS_PAGES);
    if (page_size <= 0 || free_pages <= 0) return {};
    const auto page = static_cast<std::size_t>(page_size);
    bytes = std::min(bytes, static_cast<std::size_t>(free_pages) / 2 * page);
    void* const block = bytes > 0 ? std::malloc(bytes) : nullptr;
    if (!block) return {};
    void* first = block;
    std::size_t left = bytes;
    Pages pages;
    if (std::align(page, page, first, left)) pages = {static_cast<char*>(first), left / page * page};
    std::free(block);
    return pages;
}

/// Makes pages ready, whoever has them: their contents stay as they are, and those that have been given back meanwhile
/// are refused.
void populate(Pages pages) {
    for (std::size_t done = 0; done < pages.bytes; done += kAtOnce)
        madvise(pages.first + done, std::min(kAtOnce, pages.bytes - done), kPopulate);
}

}  // namespace

void ready_memory(std::size_t bytes) {
    populate(pages_ahead(bytes));
}

void ready_memory_beside(std::size_t bytes) {
    const Pages pages = pages_ahead(bytes);
    if (pages.bytes == 0) return;
    try {
        if (thread_count() > 1) return std::thread(populate, pages).detach();
    } catch (const std::system_error&) {  // there are no more threads
    }
    populate(pages);
}

#else

void ready_memory(std::size_t) {}
void ready_memory_beside(std::size_t) {}

#endif

}  // namespace beltrami
