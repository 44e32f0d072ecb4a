#include <beltrami/base/error.h>

#include <utility>

namespace beltrami {

Error::Error(Cause cause, const std::string& sentence, const std::string& next_step, Where where)
    : std::runtime_error(next_step.empty() ? sentence : sentence + ": " + next_step),
      cause_(cause),
      where_(std::move(where)) {}

}  // namespace beltrami
