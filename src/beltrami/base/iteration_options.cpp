#include <beltrami/base/iteration_options.h>

#include <beltrami/base/error.h>

namespace beltrami {

void IterationOptions::validate() const {
    if (!(tolerance >= 0 && tolerance < 1))
        throw Error(Cause::bad_option, "the tolerance must lie between 0 and 1 (0: what suits the problem)");
    if (max_iterations < 1) throw Error(Cause::bad_option, "there must be at least one iteration");
    if (anderson_window < 0) throw Error(Cause::bad_option, "the window of the acceleration must not be negative");
}

}  // namespace beltrami
