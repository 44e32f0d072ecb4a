#include <beltrami/io/binary_source.h>

#include <fmt/format.h>

#include <beltrami/io/text_scanner.h>

namespace beltrami {

std::string BinarySource::here() const {
    return fmt::format("{}: byte {}", name_, offset_);
}

void BinarySource::fail(const std::string& what) const {
    fail_to_read(here(), what);
}

}  // namespace beltrami
