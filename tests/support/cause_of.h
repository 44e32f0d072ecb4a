#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/error.h>

namespace beltrami::test {

/// Why an attempt fails; unreadable, which nothing here throws, if it does not.
/// @param indices where the error's are put
inline Cause cause_of(const std::function<void()>& attempt, std::vector<int>* indices = nullptr) {
    try {
        attempt();
    } catch (const Error& error) {
        if (indices) *indices = error.indices();
        return error.cause();
    }
    return Cause::unreadable;
}

}  // namespace beltrami::test
