// SPDX-License-Identifier: Apache-2.0
// Reads and writes the list of a backup's files with their hashes, in the format of sha256sum(1).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"

namespace vitrine::server {

inline constexpr std::string_view kChecksums = "SHA256SUMS";

// SHA-256 of each file by its path in the archive.
using Checksums = std::map<std::string, Sha256>;

std::string to_text(const Checksums& sums);

// Returns nullopt if a line is malformed or a name occurs twice.
std::optional<Checksums> parse_checksums(std::span<const std::uint8_t> text);

}  // namespace vitrine::server
