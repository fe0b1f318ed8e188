// SPDX-License-Identifier: Apache-2.0
#include "server/auth/throttle.h"

#include <functional>
#include <random>

namespace vitrine::server {

Throttle::Throttle()
    : salt_(std::uint64_t{std::random_device{}()} << 32 | std::random_device{}()) {}

std::chrono::seconds Throttle::failed(std::string_view address, Clock::time_point now) {
  // The multiplication mixes all bits of the hash into the high bits, which select the slot.
  const std::uint64_t hash =
      (std::hash<std::string_view>{}(address) ^ salt_) * 0x9e3779b97f4a7c15ULL;
  const std::scoped_lock lock(mutex_);
  FailureCount& slot = slots_[hash >> 52];
  if (slot.failures == 0 || now - slot.start >= kWindow) slot = {now, 0};
  if (slot.failures < kFailures) {
    ++slot.failures;
    return {};
  }
  return std::chrono::ceil<std::chrono::seconds>(slot.start + kWindow - now);
}

}  // namespace vitrine::server
