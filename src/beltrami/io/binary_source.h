#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace beltrami {

/// The bytes of a number in the byte order asked for.
template <class Number>
std::array<char, sizeof(Number)> to_bytes(Number value, std::endian order) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if (order != std::endian::native) std::ranges::reverse(bytes);
    return bytes;
}

/// Walks through binary data held in memory and never past its end.
class BinarySource {
  public:
    /// @param bytes  the whole file, which must outlive the source
    /// @param offset where the binary part begins
    /// @param name   what errors call the file
    BinarySource(std::string_view bytes, std::size_t offset, std::endian order, std::string name)
        : bytes_(bytes), offset_(offset), order_(order), name_(std::move(name)) {}

    /// The next number. @throw Error unreadable at the end of the file
    template <class Number>
    Number read() {
        std::array<char, sizeof(Number)> raw;
        std::memcpy(raw.data(), take(sizeof(Number)), sizeof(Number));
        if (order_ != std::endian::native) std::ranges::reverse(raw);
        return std::bit_cast<Number>(raw);
    }
    /// Passes over bytes. @throw Error unreadable at the end of the file
    void skip(std::size_t count) { take(count); }

    std::size_t remaining() const { return bytes_.size() - offset_; }
    /// "FILE: byte OFFSET".
    std::string here() const;
    /// @throw Error unreadable "FILE: byte OFFSET: what"
    [[noreturn]] void fail(const std::string& what) const;

  private:
    const char* take(std::size_t count) {
        if (count > remaining()) fail("the file ends in the middle of its data");
        offset_ += count;
        return bytes_.data() + offset_ - count;
    }

    std::string_view bytes_;
    std::size_t offset_;
    std::endian order_;
    std::string name_;
};

}  // namespace beltrami
