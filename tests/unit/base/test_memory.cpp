#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <vector>

#include <beltrami/base/memory.h>

#if defined(__GLIBC__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#include <malloc.h>
#include <sys/resource.h>
#endif

namespace beltrami {
namespace {

TEST(ReadyMemory, TakesAnyAmount) {
    ready_memory(0);
    ready_memory(1);
    ready_memory(1 << 20);
    ready_memory_beside(0);
    ready_memory_beside(1);
    ready_memory_beside(1 << 20);
    void* const block = std::malloc(1 << 20);
    ASSERT_NE(block, nullptr);
    std::memset(block, 1, 1 << 20);
    std::free(block);
}

#if defined(__GLIBC__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
TEST(ReadyMemory, IsThereWithoutAFaultForWhatAsksNext) {
    constexpr std::size_t bytes = 48 << 20;
    const auto faults_of_use = [] {
        rusage before, after;
        getrusage(RUSAGE_SELF, &before);
        void* const block = std::malloc(bytes / 2);
        std::memset(block, 1, bytes / 2);
        std::free(block);
        getrusage(RUSAGE_SELF, &after);
        return after.ru_minflt - before.ru_minflt;
    };
    ready_memory(bytes);
    EXPECT_LT(faults_of_use(), 100);
    // And stays when it is freed.
    EXPECT_LT(faults_of_use(), 100);
}

TEST(ReadyMemory, LeavesWhatIsInItAlone) {
    constexpr std::size_t bytes = 32 << 20;
    ready_memory_beside(bytes);
    std::vector<unsigned char> own(bytes / 2);  // in the middle of what is made ready
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<unsigned char>(i % 251);
    ready_memory_beside(bytes);
    for (std::size_t i = 0; i < own.size(); ++i) ASSERT_EQ(own[i], i % 251);
}
#endif

TEST(ReadyMemory, OfAMapGrowsWithTheMesh) {
    EXPECT_EQ(memory_of_map(0), 0U);
    EXPECT_EQ(memory_of_map(1000), 2'800'000U);
    EXPECT_EQ(memory_of_map(20'000) - memory_of_map(10'000), 12'000'000U);
}

}  // namespace
}  // namespace beltrami
