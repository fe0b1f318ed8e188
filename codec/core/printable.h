// SPDX-License-Identifier: Apache-2.0
// Makes text from untrusted files safe to print.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Returns the length in bytes of the UTF-8 character at the start of `text` [RFC3629]. Returns 0 if
// `text` is empty or does not start with a well-formed character.
std::size_t utf8_size(std::string_view text);

bool is_utf8(std::string_view text);

// Replaces each control character, line separator and mark that changes the direction of text by a
// question mark. Does the same for each byte that is not valid UTF-8. The result is one line.
std::string printable_text(std::string_view text);

// Quotes the first 60 bytes of text from a file, made safe to print by printable_text(). Cuts the
// text only between characters.
std::string in_quotes(std::string_view text);

}  // namespace vitrine::inline codec
