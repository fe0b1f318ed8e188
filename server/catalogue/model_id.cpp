// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/model_id.h"

#include <sys/random.h>

#include <chrono>
#include <cstdlib>

namespace vitrine {
namespace {

constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";  // no i, l, o, u
constexpr std::size_t kLength = 26;  // 130 bits: the first digit holds three

}  // namespace

ModelId ModelId::generate() {
  ModelId id;
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  auto time = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count());
  for (std::size_t i = 6; i-- > 0; time >>= 8)
    id.bytes_[i] = static_cast<std::uint8_t>(time);
  // Up to 256 bytes never fail and never come short once the machine has started.
  if (::getrandom(&id.bytes_[6], 10, 0) != 10) std::abort();
  return id;
}

std::optional<ModelId> ModelId::parse(std::string_view text) noexcept {
  if (text.size() != kLength || text[0] > '7') return std::nullopt;
  ModelId id;
  std::uint32_t window = 0;
  int bits = -2;  // 130 digit bits carry 128
  std::size_t out = 0;
  for (const char digit : text) {
    const std::size_t value = kDigits.find(digit);
    if (value == std::string_view::npos) return std::nullopt;
    window = window << 5 | static_cast<std::uint32_t>(value);
    bits += 5;
    if (bits >= 8) id.bytes_[out++] = static_cast<std::uint8_t>(window >> (bits -= 8));
  }
  return id;
}

std::string ModelId::to_string() const {
  std::string text;
  std::uint32_t window = 0;
  int bits = 2;
  for (const std::uint8_t byte : bytes_) {
    window = window << 8 | byte;
    bits += 8;
    while (bits >= 5)
      text += kDigits[window >> (bits -= 5) & 31];
  }
  return text;
}

}  // namespace vitrine
