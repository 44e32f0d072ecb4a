#pragma once

#include <cstdint>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Costly things that are counted.
enum class Work {
    domain_chart,   ///< conformal charts, those on the way to circle domains included
    circle_chart,   ///< circle domains
    factorization,  ///< numeric factorisations of sparse systems
};

/// How often it has been done since the program began, by all threads together: differences say what a call has cost,
/// the same on every machine.
std::int64_t effort(Work work);

/// Counts one more.
void count(Work work);

}  // namespace beltrami
