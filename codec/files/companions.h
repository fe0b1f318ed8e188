// SPDX-License-Identifier: Apache-2.0
// Companions: the files to which a mesh file refers by name, such as material libraries and
// pictures.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Contents of the companion files. The key is companion_key() of the file's path.
using Companions = std::map<std::string, std::span<const std::uint8_t>, std::less<>>;

// Returns the last part of a path in lower case. Mesh files contain paths from other machines, with
// slashes or backslashes.
std::string companion_key(std::string_view path);

// Decodes the percent-encoded bytes of a URI [RFC3986] section 2.1, such as "%20" for a blank.
// Keeps a percent sign without two hexadecimal digits.
std::string percent_decoded(std::string_view uri);

std::optional<std::span<const std::uint8_t>> find_companion(const Companions& companions,
                                                            std::string_view path);

}  // namespace vitrine::inline codec
