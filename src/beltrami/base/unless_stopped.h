#pragma once

#include <functional>
#include <future>

namespace beltrami {

/// Whether a StopWhen of this thread lives.
bool stop_possible();

/// Runs work that cannot ask in between whether it is to stop: one factorisation, say. Where a StopWhen of this thread
/// lives, the work has a thread of its own and this one asks while it waits. Work that is not waited for ends by
/// itself; the program's end waits for it.
///
/// @param work owns what it touches
/// @param left becomes valid if a stop is wanted: ready once the work has ended
/// @throw Error cancelled; what the work throws
void run_unless_stopped(std::function<void()> work, std::shared_future<void>& left);

}  // namespace beltrami
