// SPDX-License-Identifier: Apache-2.0
// "Did you mean …?" for a mistyped word.
#pragma once

#include <span>
#include <string_view>

namespace vitrine {

// The candidate of the smallest edit distance to `word` (insert, delete, replace one character),
// the first among equals, or "" where none is nearer than half of the word.
std::string_view suggest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace vitrine
