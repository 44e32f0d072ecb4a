#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/where.h>

namespace beltrami BELTRAMI_PUBLIC {

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

/// Every failure of the library: a cause, a sentence, where it is and what to do next.
/// what() is "<sentence>: <next step>".
class Error : public std::runtime_error {
  public:
    /// @param sentence  what is wrong and where, in plain words, without a final full stop
    /// @param next_step what the user can do about it; may be empty
    /// @param where     offending vertices, faces, lines ...; may be nothing
    Error(Cause cause, const std::string& sentence, const std::string& next_step = {}, Where where = {});

    Cause cause() const { return cause_; }
    const Where& where() const { return where_; }
    const std::vector<int>& indices() const { return where_.indices; }

  private:
    Cause cause_;
    Where where_;
};

}  // namespace beltrami
