// SPDX-License-Identifier: Apache-2.0
// Text and numbers as they stand in the page: well-formed as XML and as HTML.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vitrine {

// Any bytes as text: what is not UTF-8 or not printable is replaced, < > & " ' are escaped.
std::string escaped(std::string_view bytes);

std::string base64(std::span<const std::uint8_t> bytes);

std::string count_text(std::uint64_t count);  // 1 234 567
std::string bytes_text(std::uint64_t bytes);  // 1.2 kB, 34 MB
std::string significant(double x);            // three digits: 0.0123, 1.23, 12 300

// A number that people read rounded and programs exactly: <data value="0.012345">0.0123</data>.
std::string count_data(std::uint64_t count);
std::string number_data(double x);

}  // namespace vitrine
