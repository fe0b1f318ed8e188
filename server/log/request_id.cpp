// SPDX-License-Identifier: Apache-2.0
#include "server/log/request_id.h"

#include <fmt/format.h>

#include <atomic>
#include <random>

namespace vitrine {

std::string next_request_id() {
  static const std::uint32_t process = std::random_device{}();
  static std::atomic<std::uint32_t> count{0};
  return fmt::format("{:08x}{:08x}", process, count.fetch_add(1, std::memory_order_relaxed));
}

}  // namespace vitrine
