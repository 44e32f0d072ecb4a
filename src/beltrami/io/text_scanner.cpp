#include <beltrami/io/text_scanner.h>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

TextScanner::TextScanner(std::string_view bytes, std::string name, Continuation continuation)
    : at_(bytes.data()),
      end_(bytes.data() + bytes.size()),
      name_(std::move(name)),
      joins_lines_(continuation == Continuation::backslash) {
    if (bytes.starts_with("\xEF\xBB\xBF")) at_ += 3;  // the byte order mark some editors put first
}

void TextScanner::pass_newline() {
    at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
    ++line_;
}

void TextScanner::pass_line() {
    bool joined = true;
    while (joined) {
        const char* start = at_;
        while (at_ != end_ && !at_newline(at_)) ++at_;
        if (at_ == end_) return;
        joined = at_ != start && at_continuation(at_ - 1);
        pass_newline();
    }
}

bool TextScanner::next_line() {
    if (started_) pass_line();
    started_ = true;
    while (at_line_end()) {
        if (at_ == end_) return false;
        pass_newline();
    }
    return true;
}

bool TextScanner::at_line_end() {
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (at_continuation(at_)) {
            ++at_;
            pass_newline();
        } else {
            break;
        }
    }
    // A comment is walked to its end here, so that a backslash that ends it joins nothing.
    if (at_ != end_ && *at_ == '#') {
        while (at_ != end_ && !at_newline(at_)) ++at_;
    }
    return at_ == end_ || at_newline(at_);
}

std::string_view TextScanner::word() {
    if (at_line_end()) return {};
    const char* start = at_;
    while (at_ != end_ && !is_blank(*at_) && !at_newline(at_) && !at_continuation(at_)) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
}

template <class Number>
Number TextScanner::spelled(std::string_view expected) {
    const std::string_view found = word();
    if (const std::optional<Number> value = spelled_number<Number>(found)) return *value;
    fail(found.empty() ? fmt::format("the line ends where {} should follow", expected)
                       : fmt::format("{} is not a number in range, where {} should be", in_quotes(found), expected));
}

double TextScanner::number(std::string_view expected) {
    return spelled<double>(expected);
}

std::int64_t TextScanner::integer(std::string_view expected) {
    return spelled<std::int64_t>(expected);
}

std::string TextScanner::here() const {
    return fmt::format("{}:{}", name_, line_);
}

void TextScanner::fail(const std::string& what) const {
    fail_to_read(here(), what, line_);
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string shown(word.substr(0, longest));
    std::ranges::replace_if(
        shown, [](unsigned char c) { return c < 0x20 || c > 0x7E; }, '?');
    return fmt::format("'{}{}'", shown, word.size() > longest ? "..." : "");
}

void fail_to_read(const std::string& place, const std::string& what, std::int64_t line) {
    std::vector<int> lines;
    if (line > 0) lines.push_back(static_cast<int>(line - 1));
    throw Error(Cause::unreadable, fmt::format("{}: {}", place, what), "mend the file or export it again",
                {Things::lines, lines});
}

}  // namespace beltrami
