// SPDX-License-Identifier: Apache-2.0
// Decompresses gzip data [RFC1952].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

bool is_gzip(std::span<const std::uint8_t> bytes);

// Returns the contents of all members of a gzip file, one after the other, and checks their
// checksums. Ignores bytes after the last member, as gzip does. Fails with kBadInput if the file is
// damaged, and with kLimit if the contents exceed `most` bytes.
Expected<std::vector<std::uint8_t>> gunzip(std::span<const std::uint8_t> bytes, std::uint64_t most);

}  // namespace vitrine::inline codec
