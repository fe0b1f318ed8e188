// SPDX-License-Identifier: Apache-2.0
// Wraps the lines of help texts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vitrine::server {

// Breaks `text` at spaces into lines of at most 100 characters. Indents all lines except the first
// by `indent` spaces. The caller puts the first line at column `indent`. A word that is too long
// for a line stays whole.
std::string wrapped(std::string_view text, std::size_t indent);

}  // namespace vitrine::server
