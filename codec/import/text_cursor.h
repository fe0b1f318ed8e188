// SPDX-License-Identifier: Apache-2.0
// Walks over text of numbers and words, line by line or ignoring lines. Lines end with LF, CR LF or
// CR. `#` starts a comment and a backslash at the end of a line joins it with the next.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace vitrine {

class TextCursor {
 public:
  explicit TextCursor(std::span<const std::uint8_t> bytes, std::uint64_t first_line = 1)
      : at_(reinterpret_cast<const char*>(bytes.data())),
        end_(at_ + bytes.size()),
        line_(first_line) {}

  bool at_end() const { return at_ == end_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  std::uint64_t line() const { return line_; }  // from 1

  // True when nothing more stands on this line.
  bool line_is_done() {
    skip_blanks();
    return at_ == end_ || ends_line(*at_) || *at_ == '#';
  }

  void next_line() {
    while (at_ != end_ && !ends_line(*at_))
      ++at_;
    if (at_ != end_) step_over_end(), ++line_;
  }

  // Goes to the next word, over lines and comments. False at the end of the text.
  bool seek_word() {
    while (line_is_done()) {
      if (at_ == end_) return false;
      next_line();
    }
    return true;
  }

  // The next word of this line, empty when there is none.
  std::string_view word() {
    if (line_is_done()) return {};
    const char* begin = at_;
    while (at_ != end_ && !is_space(*at_))
      ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  std::string_view rest_of_line() {
    skip_blanks();
    const char* begin = at_;
    while (at_ != end_ && !ends_line(*at_))
      ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  // The number at the cursor, which must be a whole word (or end at `stop`). False and unmoved when
  // there is none on this line. Works for double, float and integers.
  template <class Number>
  bool number(Number& value, char stop = ' ') {
    if (line_is_done()) return false;
    const char* begin = at_;
    if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
    const auto [after, error] = std::from_chars(begin, end_, value);
    if (error == std::errc::invalid_argument) return false;
    if (after != end_ && !is_space(*after) && *after != stop) return false;
    if (error == std::errc::result_out_of_range) value = out_of_range(value, begin, after);
    at_ = after;
    return true;
  }

  // Steps over `c` if it stands at the cursor.
  bool skip(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

 private:
  static bool ends_line(char c) { return c == '\n' || c == '\r'; }

  void step_over_end() {
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    ++at_;
  }

  static bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
  }

  // Too small a number is 0; one too large is as large as can be and is refused later.
  template <class Number>
  static Number out_of_range(Number, const char* begin, const char* end) {
    const std::string_view text(begin, static_cast<std::size_t>(end - begin));
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    if (tiny || text.starts_with("0.0")) return Number{0};
    return std::numeric_limits<Number>::max();
  }

  void skip_blanks() {
    while (at_ != end_ && !ends_line(*at_)) {
      if (is_space(*at_)) {
        ++at_;
      } else if (!join_lines()) {
        return;
      }
    }
  }

  // At a backslash that only the line's end follows: steps over both.
  bool join_lines() {
    if (*at_ != '\\' || at_ + 1 == end_ || !ends_line(at_[1])) return false;
    ++at_;
    step_over_end();
    ++line_;
    return true;
  }

  const char* at_;
  const char* end_;
  std::uint64_t line_;
};

}  // namespace vitrine
