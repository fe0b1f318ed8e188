// SPDX-License-Identifier: Apache-2.0
// Formats error messages with less code than fmt or iostreams, which keeps the WebAssembly module
// small.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Returns `text` with each "{}" replaced by the next of `numbers`, in decimal.
std::string fill_in(const char* text, std::initializer_list<std::uint64_t> numbers);
std::string join(std::initializer_list<std::string_view> parts);

}  // namespace vitrine::inline codec
