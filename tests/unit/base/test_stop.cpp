#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/base/stop.h>
#include <beltrami/base/unless_stopped.h>

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

/// What cannot ask is not waited for; whoever needs its end can.
TEST(StopWhen, LeavesWorkThatCannotAsk) {
    std::shared_future<void> left;
    const std::thread::id here = std::this_thread::get_id();
    run_unless_stopped([&] { EXPECT_EQ(std::this_thread::get_id(), here); }, left);
    EXPECT_FALSE(left.valid());
    EXPECT_THROW(run_unless_stopped([] { throw Error(Cause::not_solved, "a cause"); }, left), Error);

    auto go = std::make_shared<std::promise<void>>();
    auto ended = std::make_shared<std::atomic<bool>>(false);
    {
        bool wanted = false;
        const StopWhen stop([&] { return wanted; });
        run_unless_stopped([&] { EXPECT_NE(std::this_thread::get_id(), here); }, left);
        EXPECT_THROW(run_unless_stopped([] { throw Error(Cause::not_solved, "a cause"); }, left), Error);
        EXPECT_FALSE(left.valid());
        wanted = true;
        try {
            run_unless_stopped(
                [go, ended] {
                    go->get_future().wait();
                    *ended = true;
                },
                left);
            ADD_FAILURE() << "not stopped";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::cancelled);
        }
    }
    ASSERT_TRUE(left.valid());
    EXPECT_FALSE(*ended);
    go->set_value();
    left.wait();
    EXPECT_TRUE(*ended);
}

}  // namespace
}  // namespace beltrami
