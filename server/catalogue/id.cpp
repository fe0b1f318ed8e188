// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/id.h"

#include <sys/random.h>

#include <chrono>
#include <cstdlib>

namespace vitrine::server {
namespace {

constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";  // without i, l, o and u
constexpr std::size_t kLength = 26;  // 26 digits hold 130 bits, two more than an ID

}  // namespace

Ulid generate_ulid() {
  Ulid id{};
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  auto time = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count());
  for (std::size_t i = 6; i-- > 0; time >>= 8)
    id[i] = static_cast<std::uint8_t>(time);
  // A request of up to 256 bytes is always filled completely (getrandom(2)).
  if (::getrandom(&id[6], 10, 0) != 10) std::abort();
  return id;
}

std::optional<Ulid> parse_ulid(std::string_view text) noexcept {
  if (text.size() != kLength || text[0] > '7') return std::nullopt;
  Ulid id{};
  std::uint32_t window = 0;
  int bits = -2;  // starts below 0, because 26 digits hold 130 bits, two more than the ID
  std::size_t out = 0;
  for (const char digit : text) {
    const std::size_t value = kDigits.find(digit);
    if (value == std::string_view::npos) return std::nullopt;
    window = window << 5 | static_cast<std::uint32_t>(value);
    bits += 5;
    if (bits >= 8) id[out++] = static_cast<std::uint8_t>(window >> (bits -= 8));
  }
  return id;
}

std::string to_string(const Ulid& ulid) {
  std::string text;
  std::uint32_t window = 0;
  int bits = 2;
  for (const std::uint8_t byte : ulid) {
    window = window << 8 | byte;
    bits += 8;
    while (bits >= 5)
      text += kDigits[window >> (bits -= 5) & 31];
  }
  return text;
}

}  // namespace vitrine::server
