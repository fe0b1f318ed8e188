// SPDX-License-Identifier: Apache-2.0
#include "server/http/bodies_in_flight.h"

namespace vitrine::server {

bool BodiesInFlight::enter(const void* owner, std::uint64_t size) {
  const std::scoped_lock lock(mutex_);
  const auto other = owner == nullptr ? shared_.end() : shared_.find(owner);
  if (other != shared_.end()) {
    ++other->second.senders;
    return true;
  }
  const std::uint64_t most = max_bytes_;
  if (size > most || bytes_ > most - size) return false;
  bytes_ += size;
  if (owner != nullptr) shared_[owner] = {1, size};
  return true;
}

void BodiesInFlight::leave(const void* owner, std::uint64_t size) {
  const std::scoped_lock lock(mutex_);
  const auto shared = shared_.find(owner);
  if (shared == shared_.end()) {
    bytes_ -= size;
  } else if (--shared->second.senders == 0) {
    bytes_ -= shared->second.bytes;
    shared_.erase(shared);
  }
}

std::shared_ptr<const void> BodiesInFlight::admit(const Body& body) {
  const auto* shared = std::get_if<SharedBytes>(&body);
  const std::uint64_t size = body_size(body);
  const bool is_static = shared != nullptr && shared->owner == nullptr;
  if (std::holds_alternative<StoredBytes>(body) || is_static || size < kSmall)
    return {std::shared_ptr<const void>(), this};
  // This copy keeps the owner alive until leave(). Its address is a key of shared_, so no other
  // owner may get the same address before.
  const auto owner = shared != nullptr ? shared->owner : nullptr;
  if (!enter(owner.get(), size)) return nullptr;
  return {static_cast<const void*>(this), [self = shared_from_this(), owner, size](const void*) {
            self->leave(owner.get(), size);
          }};
}

}  // namespace vitrine::server
