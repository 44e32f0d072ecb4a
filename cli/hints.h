#pragma once

#include <string>

#include <beltrami/base/error.h>
#include <beltrami/report/record.h>

namespace beltrami::cli {

// The library names no option of the command: what it says is to be done is worded here.

/// Options that may help after an error; empty if there is nothing to add.
std::string hint(const Error& error);

/// Options that may help against what the warnings of a record and its remarks speak of, each once.
std::vector<std::string> hints(const Record& record);

}  // namespace beltrami::cli
