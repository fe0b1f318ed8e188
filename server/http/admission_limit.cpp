// SPDX-License-Identifier: Apache-2.0
#include "server/http/admission_limit.h"

#include <utility>

namespace vitrine::server {

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> AdmissionLimit::admit(
    const std::string& address) {
  auto on_release = [self = shared_from_this(), address](const void*) { self->leave(address); };
  {
    const std::scoped_lock lock(mutex_);
    if (admitted_ >= capacity_) return tl::unexpected(Refusal::kFull);
    std::size_t& own = of_address_[address];
    // The last quarter of the capacity is for addresses that have no task yet, so that a few
    // addresses cannot fill all of it.
    const bool is_shared = per_address_ < capacity_;
    const bool is_scarce = is_shared && own > 0 && admitted_ >= capacity_ - capacity_ / 4;
    if (own >= per_address_ || is_scarce) return tl::unexpected(Refusal::kAddressFull);
    ++own;
    ++admitted_;
  }
  // If the constructor of Pass throws, it calls `on_release`, so the task is no longer counted.
  return Pass(this, std::move(on_release));
}

void AdmissionLimit::leave(const std::string& address) {
  const std::scoped_lock lock(mutex_);
  --admitted_;
  const auto own = of_address_.find(address);
  if (--own->second == 0) of_address_.erase(own);
}

}  // namespace vitrine::server
