// SPDX-License-Identifier: Apache-2.0
// Appends little-endian numbers and text to a byte vector.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

static_assert(std::endian::native == std::endian::little);

class FileWriter {
 public:
  explicit FileWriter(std::size_t expected_size) { bytes_.reserve(expected_size); }

  template <class T>
  void put(T value) {
    const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  template <class Real = float>
  void put_reals(const Vec3& v) {
    put(static_cast<Real>(v.x)), put(static_cast<Real>(v.y)), put(static_cast<Real>(v.z));
  }
  void text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }

  // Writes the shortest decimal text that reads back as the same number.
  template <class T>
  void number(T value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text({digits, static_cast<std::size_t>(end - digits)});
  }
  template <class Real = float>
  void numbers(const Vec3& v, std::string_view separator = " ") {
    number(static_cast<Real>(v.x)), text(separator);
    number(static_cast<Real>(v.y)), text(separator);
    number(static_cast<Real>(v.z));
  }

  // Writes a unit vector with four decimals, so that its direction is off by at most 0.01 degrees.
  void unit_vector(const Vec3& v, std::string_view separator = " ") {
    const auto rounded = [](double part) { return std::round(part * 1e4) / 1e4 + 0.0; };
    numbers<double>({rounded(v.x), rounded(v.y), rounded(v.z)}, separator);
  }

  // Writes a string of JSON, VRML or USD. `value` must be UTF-8. Control characters are left out.
  void quoted(std::string_view value) {
    text("\"");
    for (const char c : value) {
      if (c == '"' || c == '\\') text("\\");
      if (static_cast<unsigned char>(c) >= 0x20) text({&c, 1});
    }
    text("\"");
  }

  std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace vitrine::inline codec
