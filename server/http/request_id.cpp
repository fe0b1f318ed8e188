// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_id.h"

#include <atomic>
#include <cstdint>
#include <random>
#include <string_view>

namespace vitrine::server {

std::string next_request_id() {
  static const std::uint32_t process = std::random_device{}();
  static std::atomic<std::uint32_t> count{0};
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::uint64_t number =
      std::uint64_t{process} << 32 | count.fetch_add(1, std::memory_order_relaxed);
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, number >>= 4)
    *digit = kDigits[number & 0xF];
  return text;
}

}  // namespace vitrine::server
