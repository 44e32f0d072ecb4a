#include <beltrami/base/unless_stopped.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>
#include <vector>

#include <beltrami/base/stop.h>

namespace beltrami {

namespace {

constexpr std::chrono::milliseconds kBetween(20);

/// Work that is not waited for, up to the program's end.
class Left {
  public:
    void take(const std::shared_future<void>& work) {
        const std::scoped_lock lock(mutex_);
        std::erase_if(work_,
                      [](const auto& w) { return w.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
        work_.push_back(work);
    }

  private:
    std::mutex mutex_;
    std::vector<std::shared_future<void>> work_;  // the last to leave such a future waits
};

Left& left_behind() {
    static Left all;
    return all;
}

}  // namespace

void run_unless_stopped(std::function<void()> work, std::shared_future<void>& left) {
    if (!stop_possible()) return work();
    std::shared_future<void> done = std::async(std::launch::async, std::move(work)).share();
    try {
        while (done.wait_for(kBetween) != std::future_status::ready) stop_if_wanted();
    } catch (...) {
        left_behind().take(done);
        left = std::move(done);
        throw;
    }
    done.get();
}

}  // namespace beltrami
