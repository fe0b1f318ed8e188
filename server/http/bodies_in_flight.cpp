// SPDX-License-Identifier: Apache-2.0
#include "server/http/bodies_in_flight.h"

namespace vitrine::server {

bool BodiesInFlight::enter(const void* owner, std::uint64_t size, const std::string& network) {
  const std::scoped_lock lock(mutex_);
  const auto other = owner == nullptr ? shared_.end() : shared_.find(owner);
  if (other != shared_.end()) {
    ++other->second.senders;
    return true;
  }
  const std::uint64_t most = counted_.contains(network) ? max_bytes_ / 2 : max_bytes_.load();
  if (size > most || bytes_ > most - size) return false;
  bytes_ += size;
  ++counted_[network];
  if (owner != nullptr) shared_[owner] = {1, size, network};
  return true;
}

void BodiesInFlight::leave(const void* owner, std::uint64_t size, const std::string& network) {
  const std::scoped_lock lock(mutex_);
  const auto shared = shared_.find(owner);
  if (shared == shared_.end()) {
    release(size, network);
  } else if (--shared->second.senders == 0) {
    release(shared->second.bytes, shared->second.network);
    shared_.erase(shared);
  }
}

void BodiesInFlight::release(std::uint64_t size, const std::string& network) {
  bytes_ -= size;
  const auto counted = counted_.find(network);
  if (--counted->second == 0) counted_.erase(counted);
}

std::shared_ptr<const void> BodiesInFlight::admit(const Body& body, const std::string& network) {
  const auto* shared = std::get_if<SharedBytes>(&body);
  const std::uint64_t size = body_size(body);
  const bool is_static = shared != nullptr && shared->owner == nullptr;
  if (std::holds_alternative<StoredBytes>(body) || is_static || size < kSmall)
    return {std::shared_ptr<const void>(), this};
  // The address of the owner is a key of shared_. This copy keeps the owner alive until leave(), so
  // that no other object can get the same address in the meantime.
  const auto owner = shared != nullptr ? shared->owner : nullptr;
  if (!enter(owner.get(), size, network)) return nullptr;
  return {static_cast<const void*>(this),
          [self = shared_from_this(), owner, size, network](const void*) {
            self->leave(owner.get(), size, network);
          }};
}

}  // namespace vitrine::server
