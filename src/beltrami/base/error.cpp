#include <beltrami/base/error.h>

#include <utility>

namespace beltrami {

Error::Error(Cause cause, const std::string& sentence, const std::string& next_step, std::vector<int> indices)
    : std::runtime_error(next_step.empty() ? sentence : sentence + ": " + next_step),
      cause_(cause),
      indices_(std::move(indices)) {}

}  // namespace beltrami
