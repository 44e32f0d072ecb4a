#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Core>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>

namespace beltrami {
namespace {

class Parallel : public testing::Test {
  protected:
    void TearDown() override { set_thread_count(before_); }

  private:
    int before_ = thread_count();
};

TEST_F(Parallel, VisitsEveryItemOnceOnAnyNumberOfThreads) {
    for (const int threads : {1, 2, 3, 8}) {
        set_thread_count(threads);
        EXPECT_EQ(thread_count(), threads);
        for (const int n : {0, 1, 99, 100, 101, 12345}) {
            std::vector<std::atomic<int>> visits(n);
            parallel_for(
                0, n,
                [&](int first, int last) {
                    EXPECT_LE(last - first, 100);
                    EXPECT_EQ(first % 100, 0);
                    for (int i = first; i < last; ++i) ++visits[i];
                },
                100);
            for (const auto& count : visits) ASSERT_EQ(count, 1);
        }
    }
}

TEST_F(Parallel, SumsAreTheSameBytesOnAnyNumberOfThreads) {
    const int n = 1'000'003;
    const auto chunk = [](int first, int last) {
        double sum = 0.0;
        for (int i = first; i < last; ++i) sum += std::sin(0.1 * i) * std::exp(std::cos(1.7 * i));
        return sum;
    };
    set_thread_count(1);
    const double expected = parallel_sum(n, 0.0, chunk);
    // The order of additions does matter here: one pass gives other bytes, so equality below is not a matter of course.
    EXPECT_NE(expected, chunk(0, n));
    for (const int threads : {2, 3, 8}) {
        set_thread_count(threads);
        for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(parallel_sum(n, 0.0, chunk), expected);
    }
}

TEST_F(Parallel, SumsMatrices) {
    set_thread_count(4);
    const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
    const Eigen::Vector2d sum = parallel_sum(
        10, zero, [](int first, int last) { return Eigen::Vector2d(last - first, first); }, 3);
    EXPECT_EQ(sum, Eigen::Vector2d(10, 0 + 3 + 6 + 9));
    EXPECT_EQ(parallel_sum(0, 5, [](int, int) { return 1; }), 5);
}

TEST_F(Parallel, ThrowsTheEarliestFailureAndWorksAfterwards) {
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        for (int repeat = 0; repeat < 20; ++repeat) {
            try {
                parallel_for(
                    0, 1000,
                    [](int first, int) {
                        if (first >= 300) throw std::runtime_error(std::to_string(first));
                    },
                    10);
                FAIL() << "the exception was lost";
            } catch (const std::runtime_error& error) {
                EXPECT_STREQ(error.what(), "300");
            }
        }
        EXPECT_EQ(parallel_sum(
                      1000, 0, [](int first, int last) { return last - first; }, 10),
                  1000);
    }
}

TEST_F(Parallel, NestedCallsRunSerially) {
    set_thread_count(4);
    std::atomic<int> count = 0;
    std::atomic<bool> left_thread = false;
    parallel_for(
        0, 8,
        [&](int, int) {
            const std::thread::id mine = std::this_thread::get_id();
            parallel_for(
                0, 100,
                [&](int first, int last) {
                    if (std::this_thread::get_id() != mine) left_thread = true;
                    count += last - first;
                },
                7);
        },
        1);
    EXPECT_EQ(count, 800);
    EXPECT_FALSE(left_thread);
}

TEST_F(Parallel, SeveralCallersAtOnce) {
    set_thread_count(3);
    std::vector<std::thread> callers;
    std::atomic<int> right = 0;
    for (int c = 0; c < 4; ++c) {
        callers.emplace_back([&] {
            for (int repeat = 0; repeat < 50; ++repeat) {
                right += parallel_sum(
                             5000, 0, [](int first, int last) { return last - first; }, 64) == 5000;
            }
        });
    }
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(right, 200);
}

TEST_F(Parallel, RefusesNoThreads) {
    EXPECT_THROW(set_thread_count(0), Error);
    EXPECT_THROW(set_thread_count(-3), Error);
}

TEST_F(Parallel, WorksInAForkedProcess) {
    set_thread_count(3);
    const auto sum = [] {
        return parallel_sum(
            1000, 0, [](int first, int last) { return last - first; }, 10);
    };
    EXPECT_EQ(sum(), 1000);
    const pid_t child = fork();
    if (child == 0) {
        alarm(20);  // it hangs where it waits for threads that the parent has
        _exit(sum() == 1000 && thread_count() == 3 ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(sum(), 1000);
}

}  // namespace
}  // namespace beltrami
