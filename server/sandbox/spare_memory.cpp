// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/spare_memory.h"

#include <algorithm>

namespace vitrine::server {

void* SpareMemory::take(std::size_t bytes) noexcept {
  if (bytes > kMost) return nullptr;
  const std::size_t units = std::max<std::size_t>(1, (bytes + kUnit - 1) / kUnit);
  const std::scoped_lock lock(mutex_);
  for (std::size_t at = 0, free = 0; at < kUnits;) {
    if (lengths_[at] > 0) {
      at += lengths_[at];
      free = 0;
    } else if (++at, ++free == units) {
      lengths_[at - units] = static_cast<std::uint16_t>(units);
      return &bytes_[(at - units) * kUnit];
    }
  }
  return nullptr;
}

bool SpareMemory::give_back(void* block) noexcept {
  const auto at =
      reinterpret_cast<std::uintptr_t>(block) - reinterpret_cast<std::uintptr_t>(bytes_.data());
  if (at >= bytes_.size()) return false;
  const std::scoped_lock lock(mutex_);
  lengths_[at / kUnit] = 0;
  return true;
}

}  // namespace vitrine::server
