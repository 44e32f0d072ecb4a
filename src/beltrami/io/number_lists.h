#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Reads a text file of numbers: one row a line, separated by blanks; # begins a comment; blank lines are passed over.
/// @param columns how many numbers each row must have
/// @param what    what a row is, for the error: "a mark", "a pinned vertex"
/// @throw Error unreadable with file and line
std::vector<std::vector<double>> read_rows(const std::filesystem::path& path, int columns, const std::string& what);

/// A row of numbers and the line it stands on, counted from 1.
struct NumberRow {
    std::int64_t line;
    std::vector<double> numbers;
};

/// Reads a text file whose rows need not have equally many numbers.
/// @param least, most how many numbers a row may have
/// @param what        what a row is, for the error
/// @throw Error unreadable with file and line
std::vector<NumberRow> read_number_rows(const std::filesystem::path& path, int least, int most,
                                        const std::string& what);

/// Rows that begin with indices, as lists of pins, marks and corners do.
struct IndexedRows {
    Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> indices;  ///< #rows × index_columns
    Positions values;                                                             ///< #rows × value_columns
};

/// Whether a value may be left open by a `*`.
enum class Stars { refused, read_as_nan };

/// As read_rows(), where the first columns are indices.
/// @param index_columns how many: whole numbers in [0, limit)
/// @param value_columns how many other numbers follow them
/// @param stars         read_as_nan: a value may be `*`, and becomes NaN; one that is NaN itself is refused then
/// @throw Error unreadable with file and line
IndexedRows read_indexed_rows(const std::filesystem::path& path, int index_columns, int limit, int value_columns,
                              const std::string& what, Stars stars = Stars::refused);

}  // namespace beltrami
