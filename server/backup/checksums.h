// SPDX-License-Identifier: Apache-2.0
// Reads and writes the list of the files in a backup and their hashes, in the format of
// sha256sum(1).
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"

namespace vitrine::server {

inline constexpr std::string_view kChecksums = "SHA256SUMS";
// Name of the list of objects that were damaged or missing when the backup was made.
inline constexpr std::string_view kDamagedList = "DAMAGED";

// Returns the path of an object, which is the same in a backup and in a data folder.
std::string object_path(const Sha256& name);

// Maps the path of each file in the archive to the file's SHA-256.
using Checksums = std::map<std::string, Sha256>;

std::string to_text(const Checksums& sums);

// Returns nullopt if a line is malformed or a name occurs twice.
std::optional<Checksums> parse_checksums(std::span<const std::uint8_t> text);

}  // namespace vitrine::server
