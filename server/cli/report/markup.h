// SPDX-License-Identifier: Apache-2.0
// Formats text and numbers for the page, valid both as XML and as HTML.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::server {

// Converts any bytes to text. Replaces bytes that are not UTF-8 or not printable, and escapes < > &
// " '.
std::string escaped(std::string_view bytes);

std::string base64(std::span<const std::uint8_t> bytes);

std::string count_text(std::uint64_t count);  // returns a text such as 1 234 567
std::string bytes_text(std::uint64_t bytes);  // returns a text such as 1.2 kB or 34 MB
std::string significant(double x);  // returns three digits, such as 0.0123, 1.23 or 12 300

// These functions format a number as an element whose text is rounded and whose value is exact,
// such as <data value="0.012345">0.0123</data>.
std::string count_data(std::uint64_t count);
std::string number_data(double x);

}  // namespace vitrine::server
