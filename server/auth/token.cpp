// SPDX-License-Identifier: Apache-2.0
#include "server/auth/token.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace vitrine::server {
namespace {

constexpr std::string_view kPrefix = "vtr_";
constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::size_t kLength = 4 + 43;  // "vtr_", and 43 base64url digits for 256 bits

}  // namespace

std::string generate_token() {
  std::array<std::uint8_t, 32> bytes;
  // A request of up to 256 bytes is always filled completely (getrandom(2)).
  if (::getrandom(bytes.data(), bytes.size(), 0) != std::ssize(bytes)) std::abort();
  std::string text(kPrefix);
  std::uint32_t window = 0;
  int bits = 0;
  for (const std::uint8_t byte : bytes) {
    window = window << 8 | byte;
    bits += 8;
    while (bits >= 6)
      text += kDigits[window >> (bits -= 6) & 63];
  }
  text += kDigits[window << (6 - bits) & 63];
  return text;
}

std::optional<Sha256> token_hash(std::string_view text) noexcept {
  if (text.size() != kLength || !text.starts_with(kPrefix)) return std::nullopt;
  const auto digits = text.substr(kPrefix.size());
  if (digits.find_first_not_of(kDigits) != std::string_view::npos) return std::nullopt;
  return sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace vitrine::server
