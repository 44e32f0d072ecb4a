#pragma once

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Name and version of the backend this library was built with, e.g. "CHOLMOD 3.0.14".
const char* linear_backend();

}  // namespace beltrami
