#pragma once

#include <functional>

#include <beltrami/base/error.h>

namespace beltrami::test {

/// Why an attempt fails; unreadable, which nothing here throws, if it does not.
inline Cause cause_of(const std::function<void()>& attempt) {
    try {
        attempt();
    } catch (const Error& error) {
        return error.cause();
    }
    return Cause::unreadable;
}

}  // namespace beltrami::test
