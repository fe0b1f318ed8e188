// SPDX-License-Identifier: Apache-2.0
// Files that a mesh file refers to by name: material libraries and pictures.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitrine {

// Contents by companion_key() of the file's name.
using Companions = std::map<std::string, std::span<const std::uint8_t>, std::less<>>;

// The last part of a path, in lower case: files name their companions by the paths of another
// machine, with slashes of either kind.
std::string companion_key(std::string_view path);

std::optional<std::span<const std::uint8_t>> find_companion(const Companions& companions,
                                                            std::string_view path);

}  // namespace vitrine
