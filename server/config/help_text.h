// SPDX-License-Identifier: Apache-2.0
// Helps to write help texts and error messages: breaks lines, and finds the word that the user may
// have meant.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::server {

// Breaks `text` at spaces into lines of at most 100 characters. Indents all lines except the first
// by `indent` spaces. The caller puts the first line at column `indent`. A word that is too long
// for a line stays whole.
std::string wrapped(std::string_view text, std::size_t indent);

// Returns the candidate with the smallest edit distance to `word`. If several candidates have this
// distance, returns the first. One edit inserts, deletes or replaces one character. Returns an
// empty text if all distances are more than half of the word's length.
std::string_view suggest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace vitrine::server
