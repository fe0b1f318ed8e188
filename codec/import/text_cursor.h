// SPDX-License-Identifier: Apache-2.0
// Reads numbers and words from text, within a line or across lines. Lines end with LF, CR LF or CR.
// `#` starts a comment. A backslash at the end of a line joins the line with the next one.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "codec/core/parse_number.h"

namespace vitrine::inline codec {

class TextCursor {
 public:
  explicit TextCursor(std::span<const std::uint8_t> bytes, std::uint64_t first_line = 1)
      : at_(reinterpret_cast<const char*>(bytes.data())),
        end_(at_ + bytes.size()),
        line_(first_line) {}

  bool is_at_end() const { return at_ == end_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  std::uint64_t line() const { return line_; }  // number of the current line, from 1

  // Whether the rest of the line is blank or a comment.
  bool line_is_done() {
    skip_blanks();
    return at_ == end_ || ends_line(*at_) || *at_ == '#';
  }

  void next_line() {
    while (at_ != end_ && !ends_line(*at_))
      ++at_;
    if (at_ != end_) step_over_end(), ++line_;
  }

  // Moves to the next word. Skips line ends and comments. Returns false at the end of the text.
  bool seek_word() {
    while (line_is_done()) {
      if (at_ == end_) return false;
      next_line();
    }
    return true;
  }

  // Returns the next word of the line, or an empty string if there is none.
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

  // Reads the number at the cursor: a double, float or integer. A real number may have the exponent
  // of Fortran, as in 1.0D+00. The number must be a whole word or be followed by `stop`. If the
  // line has no such number, returns false and leaves the cursor before the word.
  template <class Number>
  bool read_number(Number& value, char stop = ' ') {
    if (line_is_done()) return false;
    const char* begin = at_;
    if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
    const auto [after, error] = std::from_chars(begin, end_, value);
    if (error == std::errc::invalid_argument) return false;
    if (after != end_ && !is_space(*after) && *after != stop) {
      if constexpr (std::is_floating_point_v<Number>)
        return read_fortran(begin, after, value, stop);
      return false;
    }
    if (error == std::errc::result_out_of_range) value = out_of_range(value, begin, after);
    at_ = after;
    return true;
  }

  // Whether the cursor is at the end of a word: before a blank, at a joined line end, or at the end
  // of the text.
  bool is_after_word() const { return at_ == end_ || is_space(*at_) || joins_lines(); }

  // Whether the next word looks like a number with a decimal comma, such as "0,5".
  bool has_decimal_comma() const {
    const std::string_view next = TextCursor(*this).word();
    const std::size_t comma = next.find(',');
    return comma != next.npos && comma > 0 && comma + 1 < next.size() &&
           next.find_first_not_of("0123456789+-,eE") == next.npos;
  }

  // If `c` is at the cursor, skips it and returns true.
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

  // Reads the number at `begin` if its exponent, at `mark`, begins with the letter D.
  template <class Number>
  bool read_fortran(const char* begin, const char* mark, Number& value, char stop) {
    constexpr std::ptrdiff_t kMostCharacters = 64;
    if (*mark != 'D' && *mark != 'd') return false;
    const char* end = mark;
    while (end != end_ && !is_space(*end) && *end != stop && end - begin < kMostCharacters)
      ++end;
    std::string text(begin, end);
    text[static_cast<std::size_t>(mark - begin)] = 'e';
    TextCursor copy({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    if (!copy.read_number(value) || !copy.is_at_end()) return false;
    at_ = end;
    return true;
  }

  // Returns a substitute for a number that is out of range: 0 if it is too small, the type's
  // largest value if it is too large. Later checks refuse the largest value.
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

  bool joins_lines() const { return *at_ == '\\' && at_ + 1 != end_ && ends_line(at_[1]); }

  // Skips a backslash at the end of the line and the line end after it. Returns false if there is
  // no such backslash.
  bool join_lines() {
    if (!joins_lines()) return false;
    ++at_;
    step_over_end();
    ++line_;
    return true;
  }

  const char* at_;
  const char* end_;
  std::uint64_t line_;
};

// Returns the text with A to Z changed to lower case.
inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

inline constexpr std::string_view kDecimalCommas =
    "numbers have decimal commas; write them with points";

// Parses all of `text` as a real number with a decimal point or comma. Some exporters write commas.
inline std::optional<double> parse_real(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos) return parse_number<double>(text);
  std::string with_point(text);
  with_point[comma] = '.';
  return parse_number<double>(with_point);
}

inline std::string_view first_word(std::span<const std::uint8_t> bytes) {
  TextCursor text(bytes);
  return text.seek_word() ? text.word() : std::string_view{};
}

}  // namespace vitrine::inline codec
