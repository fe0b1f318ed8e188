// SPDX-License-Identifier: Apache-2.0
// SHA-256 (FIPS 180-4). Stored objects are named by this hash.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::inline codec {

using Sha256 = std::array<std::uint8_t, 32>;

Sha256 sha256(std::span<const std::uint8_t> bytes) noexcept;

std::string to_hex(const Sha256& digest);  // 64 lower-case hexadecimal digits
// Parses `text` into `digest`. Returns false unless `text` is 64 lower-case hexadecimal digits.
bool from_hex(std::string_view text, Sha256& digest) noexcept;

}  // namespace vitrine::inline codec
