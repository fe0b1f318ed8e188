// SPDX-License-Identifier: Apache-2.0
#include "server/http/seats.h"

#include <utility>

namespace vitrine {

tl::expected<Seats::Seat, Seats::Refusal> Seats::take(const std::string& who) {
  auto rise = [self = shared_from_this(), who](const void*) { self->leave(who); };
  {
    const std::scoped_lock lock(mutex_);
    if (taken_ >= capacity_) return tl::unexpected(Refusal::kFull);
    std::size_t& own = of_address_[who];
    if (own >= per_address_) return tl::unexpected(Refusal::kAddressFull);
    ++own;
    ++taken_;
  }
  return Seat(this, std::move(rise));  // rises at once where that throws
}

void Seats::leave(const std::string& who) {
  const std::scoped_lock lock(mutex_);
  --taken_;
  const auto own = of_address_.find(who);
  if (--own->second == 0) of_address_.erase(own);
}

}  // namespace vitrine
