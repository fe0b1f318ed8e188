// SPDX-License-Identifier: Apache-2.0
// Suggests the known word that a mistyped word was probably meant to be.
#pragma once

#include <span>
#include <string_view>

namespace vitrine::server {

// Returns the candidate with the smallest edit distance to `word`. If several candidates have this
// distance, returns the first. One edit inserts, deletes or replaces one character. Returns an
// empty text if all distances are more than half of the word's length.
std::string_view suggest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace vitrine::server
