#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The number that a whole word spells, in any locale; nothing if it spells none or one out of range.
template <class Number>
std::optional<Number> spelled_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);  // from_chars knows no plus sign
    const char* end = word.data() + word.size();
    Number value{};
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc{} || stop != end) return std::nullopt;
    return value;
}

/// Walks through the lines and words of a text held in memory. Lines end with LF, CR LF or CR; words are separated by
/// blanks and tabs; a word that begins with # starts a comment; blank lines are passed over. Nothing is copied.
class TextScanner {
  public:
    enum class Continuation { none, backslash };  ///< backslash: one before the end of a line joins the next line to it

    /// @param bytes the text, which must outlive the scanner
    /// @param name  what errors call it
    TextScanner(std::string_view bytes, std::string name, Continuation continuation = Continuation::none);

    /// Goes to the next line that holds a word; false at the end of the text.
    bool next_line();
    /// True if the line holds no further word.
    bool at_line_end();
    /// The next word of the line; empty at its end.
    std::string_view word();
    /// The next word of the line as a number. @throw Error unreadable if it is none; `expected` says what it should be
    double number(std::string_view expected);
    /// The next word of the line as a whole number. @throw Error unreadable as number()
    std::int64_t integer(std::string_view expected);

    /// Number of the current line, from 1.
    std::int64_t line() const { return line_; }
    /// "FILE:LINE".
    std::string here() const;
    /// The text not yet walked through.
    std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }
    /// @throw Error unreadable "FILE:LINE: what"
    [[noreturn]] void fail(const std::string& what) const;

  private:
    bool at_newline(const char* at) const { return at != end_ && (*at == '\n' || *at == '\r'); }
    bool at_continuation(const char* at) const { return joins_lines_ && *at == '\\' && at_newline(at + 1); }
    void pass_newline();
    void pass_line();
    template <class Number>
    Number spelled(std::string_view expected);

    const char* at_;
    const char* end_;
    std::string name_;
    std::int64_t line_ = 1;
    bool joins_lines_;
    bool started_ = false;
};

/// A word of a file as an error message may show it: in quotes, shortened, unprintable bytes as '?'.
std::string in_quotes(std::string_view word);

/// @param line offending line from 1; 0 if the place is none
/// @throw Error unreadable "place: what", with the usual next step for a broken file
[[noreturn]] void fail_to_read(const std::string& place, const std::string& what, std::int64_t line = 0);

}  // namespace beltrami
