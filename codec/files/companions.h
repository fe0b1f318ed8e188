// SPDX-License-Identifier: Apache-2.0
// Companions are the files to which a mesh file refers by name, such as material libraries and
// pictures.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Contents of the companion files. The key is the companion_key() of the file's path.
using Companions = std::map<std::string, std::span<const std::uint8_t>, std::less<>>;

// Returns the text as UTF-8. Text that is not valid UTF-8 counts as windows-1252, in which older
// programs write names.
std::string as_utf8(std::string_view text);

// Returns the last part of a path, in lower case and as UTF-8. Both slashes and backslashes
// separate parts, because mesh files contain paths from other machines.
std::string companion_key(std::string_view path);

// Decodes the percent-encoded bytes of a URI ([RFC3986] section 2.1), such as "%20" for a space.
// Leaves a percent sign as it is if two hexadecimal digits do not follow it.
std::string percent_decoded(std::string_view uri);

// The kinds of companions, by the extensions of their names. kPicture includes formats that cannot
// be read, so that a reader can name the format in a message.
enum class CompanionKind : std::uint8_t { kOther, kLibrary, kBuffer, kPicture };
CompanionKind companion_kind(std::string_view key);

std::optional<std::span<const std::uint8_t>> find_companion(const Companions& companions,
                                                            std::string_view path);

}  // namespace vitrine::inline codec
