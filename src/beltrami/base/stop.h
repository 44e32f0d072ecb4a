#pragma once

#include <functional>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// While it lives, long computations of this thread ask from time to time whether they are to stop: at every loop over
/// a mesh and every solve, but not more often than every 20 ms. For callers that cannot wait for the next call of an
/// iteration's progress, as charts and factorisations come before the first.
///
///     const StopWhen stop([&] { return button.pressed(); });
///     extremal_map(surface, constraints);   // Error cancelled, once it is
class StopWhen {
  public:
    /// @param wanted called on this thread only, and no more once it has said yes: all that follows is cancelled then
    explicit StopWhen(std::function<bool()> wanted);
    /// The one that was there before is asked again.
    ~StopWhen();
    StopWhen(const StopWhen&) = delete;
    StopWhen& operator=(const StopWhen&) = delete;

  private:
    friend void stop_if_wanted();
    struct State;
    State* state_;
};

/// @throw Error cancelled if a StopWhen of this thread wants that
void stop_if_wanted();

}  // namespace beltrami
