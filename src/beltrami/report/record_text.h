#pragma once

#include <string>

#include <beltrami/base/public.h>
#include <beltrami/report/record.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The record's map and comparison as a table for the terminal; empty without a map.
/// @param method name of the record's own map
std::string to_table(const Record& record, const std::string& method);

/// Homotopy class, corners, folds removed, the largest |μ|, circles and moduli, how well a coefficient was met, as far
/// as they are there: lines for the terminal.
std::string to_remarks(const Record& record);

/// What the lower bound on K says and how near the map comes, in plain words for the terminal; empty without a bound.
std::string to_sentence(const Record& record);

}  // namespace beltrami
