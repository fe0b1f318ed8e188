// SPDX-License-Identifier: Apache-2.0
#include "server/auth/rate_limit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace vitrine::server {

RateLimit::RateLimit(std::uint32_t rate)
    : rate_(rate), salt_(std::uint64_t{std::random_device{}()} << 32 | std::random_device{}()) {}

std::chrono::seconds RateLimit::take(std::string_view who, Clock::time_point now) {
  if (rate_ == 0) return {};
  // The multiplication mixes all bits of the hash into the high bits, which select the budget.
  const std::uint64_t hash = (std::hash<std::string_view>{}(who) ^ salt_) * 0x9e3779b97f4a7c15ULL;
  const std::scoped_lock lock(mutex_);
  Budget& budget = budgets_[hash >> 52];
  const double most = rate_ * kBurst;
  const std::chrono::duration<double> passed = now - budget.since;
  const bool unused = budget.since == Clock::time_point{};
  const double calls = unused ? most : std::min(most, budget.calls + passed.count() * rate_);
  const bool allowed = calls >= 1;
  budget = {now, calls - (allowed ? 1 : 0)};
  if (allowed) return {};
  return std::chrono::seconds(std::max(1L, std::lround(std::ceil((1 - calls) / rate_))));
}

}  // namespace vitrine::server
