// SPDX-License-Identifier: Apache-2.0
// Checks texts from outside before they are shown to people.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::server {

// Whether `text` is well-formed UTF-8 ([RFC3629]: no overlong forms, no surrogates) without control
// characters.
bool is_plain_text(std::string_view text) noexcept;

// Returns `text` as one line of plain text: replaces each byte of a control character, and each
// byte that is not UTF-8, by \xNN.
std::string as_plain_text(std::string_view text);

// Largest sizes in bytes of a text of one line, and of a text of several paragraphs.
inline constexpr std::size_t kMaxLineBytes = 4096, kMaxParagraphBytes = 16'384;

// Whether `text` is a line that may be shown: plain text of at most kMaxLineBytes.
bool is_line(std::string_view text) noexcept;
// Whether `text` is plain text, apart from line feeds, and has at most kMaxParagraphBytes.
bool is_paragraphs(std::string_view text) noexcept;

// Returns the lines as one text, for which is_paragraphs() is true. Makes each line plain text. If
// not all lines fit, the last line says how many are missing.
std::string joined_lines(std::span<const std::string> lines);
// Returns the lines of `text`. An empty text has no lines.
std::vector<std::string> lines_of(std::string_view text);

}  // namespace vitrine::server
