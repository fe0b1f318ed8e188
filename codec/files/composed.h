// SPDX-License-Identifier: Apache-2.0
// Makes names comparable that systems write with different characters. For example, "\u00E9" is one
// character, or the letter e and a mark as in file names on macOS.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Replaces each letter and the marks after it by one character, if Unicode has such a character.
// The result is the form NFC [UAX15] for Latin, Greek, Cyrillic and Japanese. Other characters, and
// bytes that are not UTF-8, do not change.
std::string composed(std::string_view text);

}  // namespace vitrine::inline codec
