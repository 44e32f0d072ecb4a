#pragma once

#include <string>
#include <vector>

#include <beltrami/base/error.h>

namespace beltrami {

/// Does something for shapes among several and puts a name before what goes wrong.
/// @param shapes that the error names
/// @throw Error of the same cause; cancelled as it is
template <class Action>
void naming(const std::string& name, const std::vector<int>& shapes, const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        if (error.cause() == Cause::cancelled) throw;
        throw Error(error.cause(), name + ": " + error.what(), {}, {Things::shapes, shapes});
    }
}

}  // namespace beltrami
