#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace beltrami {

/// Why something could not be done. The command's exit code is a function of the cause alone.
enum class Cause {
    bad_option,    ///< an option or argument has an impossible value
    unreadable,    ///< a file is missing, truncated, malformed or too large to be true
    bad_mesh,      ///< the mesh cannot carry the computation (see diagnose)
    bad_boundary,  ///< boundary data is missing, contradictory or impossible
    not_solved,    ///< a factorisation or an iteration failed
    unwritable,    ///< an output could not be written
    cancelled,     ///< the caller asked to stop
};

/// Every failure of the library: a cause, a sentence, the offending indices and what to do next.
/// what() is "<sentence>: <next step>".
class Error : public std::runtime_error {
  public:
    /// @param sentence  what is wrong and where, in plain words, without a final full stop
    /// @param next_step what the user can do about it; may be empty
    /// @param indices   offending vertices, faces or lines, counted from 0; may be empty
    Error(Cause cause, const std::string& sentence, const std::string& next_step = {}, std::vector<int> indices = {});

    Cause cause() const { return cause_; }
    const std::vector<int>& indices() const { return indices_; }

  private:
    Cause cause_;
    std::vector<int> indices_;
};

}  // namespace beltrami
