// SPDX-License-Identifier: Apache-2.0
// SHA-256 [FIPS180]. Stored objects are named by this hash.
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

// Computes the SHA-256 of bytes that arrive in pieces of any size.
class Sha256Hasher {
 public:
  void add(std::span<const std::uint8_t> bytes) noexcept;
  Sha256 finish() noexcept;  // returns the hash of all bytes added; call it once, at the end

 private:
  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};  // bytes that do not fill a block yet
  std::uint64_t size_ = 0;                // number of bytes added
};

std::string to_hex(const Sha256& digest);  // 64 lower-case hexadecimal digits
// Parses 64 lower-case hexadecimal digits into `digest`. Returns false if `text` is anything else.
bool from_hex(std::string_view text, Sha256& digest) noexcept;

}  // namespace vitrine::inline codec
