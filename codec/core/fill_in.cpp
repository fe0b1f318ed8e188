// SPDX-License-Identifier: Apache-2.0
#include "codec/core/fill_in.h"

namespace vitrine::inline codec {
namespace {

void add_digits(std::string& text, std::uint64_t number) {
  if (number >= 10) add_digits(text, number / 10);
  text += static_cast<char>('0' + number % 10);
}

}  // namespace

std::string fill_in(const char* text, std::initializer_list<std::uint64_t> numbers) {
  std::string filled;
  for (auto number = numbers.begin(); *text != 0; ++text) {
    if (*text != '{' || number == numbers.end()) {
      filled += *text;
    } else {
      add_digits(filled, *number++);
      ++text;
    }
  }
  return filled;
}

std::string join(std::initializer_list<std::string_view> parts) {
  std::string joined;
  for (const std::string_view part : parts) {
    for (const char c : part)
      joined += c;
  }
  return joined;
}

}  // namespace vitrine::inline codec
