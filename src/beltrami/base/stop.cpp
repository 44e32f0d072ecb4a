#include <beltrami/base/stop.h>

#include <chrono>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/unless_stopped.h>

namespace beltrami {

struct StopWhen::State {
    std::function<bool()> wanted;
    State* outer;
    std::chrono::steady_clock::time_point asked = {};
    bool stopped = false;
};

namespace {
// Of the innermost StopWhen of the thread. Not State*, which is private.
thread_local void* innermost = nullptr;
}  // namespace

StopWhen::StopWhen(std::function<bool()> wanted)
    : state_(new State{std::move(wanted), static_cast<State*>(innermost)}) {
    innermost = state_;
}

StopWhen::~StopWhen() {
    innermost = state_->outer;
    delete state_;
}

bool stop_possible() {
    return innermost != nullptr;
}

void stop_if_wanted() {
    if (!innermost) return;
    StopWhen::State& state = *static_cast<StopWhen::State*>(innermost);
    if (!state.stopped) {
        const auto now = std::chrono::steady_clock::now();
        if (now - state.asked < std::chrono::milliseconds(20)) return;
        state.asked = now;
        state.stopped = state.wanted();
    }
    if (state.stopped) throw Error(Cause::cancelled, "stopped on request");
}

}  // namespace beltrami
