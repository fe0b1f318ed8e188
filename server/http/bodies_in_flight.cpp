// SPDX-License-Identifier: Apache-2.0
#include "server/http/bodies_in_flight.h"

namespace vitrine::server {

bool BodiesInFlight::has_room(std::uint64_t size, const std::string& network) const {
  const std::uint64_t max = max_bytes_;
  const auto found = of_network_.find(network);
  const std::uint64_t own = found == of_network_.end() ? 0 : found->second;
  const std::uint64_t usable = is_modest(own + size, max) ? max : without_reserve(max);
  if (size > usable || bytes_ > usable - size) return false;
  return own == 0 || own + size <= max / 4;
}

bool BodiesInFlight::enter(const void* owner, std::uint64_t size, const std::string& network) {
  const std::scoped_lock lock(mutex_);
  const auto other = owner == nullptr ? shared_.end() : shared_.find(owner);
  const bool is_new = other == shared_.end();
  if (is_new && !has_room(size, network)) return false;
  if (is_new) bytes_ += size;
  if (owner == nullptr) {
    of_network_[network] += size;
    return true;
  }
  Shared& shared = is_new ? shared_[owner] : other->second;
  if (is_new) shared.bytes = size;
  if (++shared.senders[network] == 1) of_network_[network] += shared.bytes;
  return true;
}

void BodiesInFlight::leave(const void* owner, std::uint64_t size, const std::string& network) {
  const std::scoped_lock lock(mutex_);
  const auto shared = shared_.find(owner);
  if (shared == shared_.end()) {
    bytes_ -= size;
    return count_less(size, network);
  }
  auto& [bytes, senders] = shared->second;
  const auto own = senders.find(network);
  if (--own->second > 0) return;
  senders.erase(own);
  count_less(bytes, network);
  if (!senders.empty()) return;
  bytes_ -= bytes;
  shared_.erase(shared);
}

void BodiesInFlight::count_less(std::uint64_t size, const std::string& network) {
  const auto own = of_network_.find(network);
  own->second -= size;
  if (own->second == 0) of_network_.erase(own);
}

std::shared_ptr<const void> BodiesInFlight::admit(const Body& body, const std::string& network) {
  if (!counts(body)) return {std::shared_ptr<const void>(), this};
  const auto* shared = std::get_if<SharedBytes>(&body);
  const std::uint64_t size = body_memory(body);
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
