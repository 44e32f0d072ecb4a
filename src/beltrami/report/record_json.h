#pragma once

#include <string>

#include <beltrami/base/public.h>
#include <beltrami/report/record.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The record as JSON (docs/json.md), keys in the documented order, ending with a newline.
std::string to_json(const Record& record);

}  // namespace beltrami
