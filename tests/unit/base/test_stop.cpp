#include <gtest/gtest.h>

#include <thread>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/base/stop.h>

namespace beltrami {
namespace {

/// Whether a loop over three chunks is cancelled.
bool stops() {
    try {
        parallel_for_each(3, [](int) {});
    } catch (const Error& error) {
        return error.cause() == Cause::cancelled;
    }
    return false;
}

TEST(StopWhen, CancelsLoopsOfItsThreadWhileItLives) {
    EXPECT_FALSE(stops());
    {
        int asked = 0;
        const StopWhen stop([&] { return ++asked > 0; });
        EXPECT_TRUE(stops());
        EXPECT_TRUE(stops());  // it is not asked again, and all that follows is cancelled too
        EXPECT_EQ(asked, 1);
        bool other = true;
        std::thread([&] { other = stops(); }).join();
        EXPECT_FALSE(other);
    }
    EXPECT_FALSE(stops());
}

TEST(StopWhen, IsNotAskedAllTheTime) {
    int asked = 0;
    const StopWhen stop([&] {
        ++asked;
        return false;
    });
    for (int i = 0; i < 1000; ++i) stop_if_wanted();
    EXPECT_GE(asked, 1);
    EXPECT_LT(asked, 100);
}

TEST(StopWhen, GivesWayToTheOneBefore) {
    const StopWhen outer([] { return true; });
    {
        const StopWhen inner([] { return false; });
        EXPECT_FALSE(stops());
    }
    EXPECT_TRUE(stops());
}

}  // namespace
}  // namespace beltrami
