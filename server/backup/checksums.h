// SPDX-License-Identifier: Apache-2.0
// The names and hashes of a backup's files, as sha256sum(1) writes and checks them.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"

namespace vitrine {

inline constexpr std::string_view kChecksums = "SHA256SUMS";

// By the path in the archive.
using Checksums = std::map<std::string, Sha256>;

std::string to_text(const Checksums& sums);

// Nothing where a line is none, or a name comes twice.
std::optional<Checksums> parse_checksums(std::span<const std::uint8_t> text);

}  // namespace vitrine
