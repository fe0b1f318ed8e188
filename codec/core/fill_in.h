// SPDX-License-Identifier: Apache-2.0
// The texts of errors, in few bytes of the browser's module.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace vitrine {

// The text with one number after the other in the place of each "{}".
std::string fill_in(const char* text, std::initializer_list<std::uint64_t> numbers);
std::string join(std::initializer_list<std::string_view> parts);

}  // namespace vitrine
