// SPDX-License-Identifier: Apache-2.0
// The memory that answers hold until their readers have taken them: the slowest decide how long.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "server/http/body.h"

namespace vitrine {

// Thread-safe. Owned by shared pointers: what it has admitted keeps it.
class BodiesInFlight : public std::enable_shared_from_this<BodiesInFlight> {
 public:
  // Those under way come to `max_bytes` at most.
  explicit BodiesInFlight(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void set_capacity(std::uint64_t max_bytes) { max_bytes_ = max_bytes; }

  // Keep it until `body` is sent; null where there is no room. A text counts as what it has, shared
  // memory once however many send it, and what is stored or below kSmall not at all: every
  // connection may have that.
  std::shared_ptr<const void> admit(const Body& body);

  // Whether there will be room for it once others have gone.
  bool fits_alone(const Body& body) const { return body_size(body) <= max_bytes_; }

  static constexpr std::uint64_t kSmall = 16 * 1024;

 private:
  struct Shared {
    std::size_t senders = 0;
    std::uint64_t bytes = 0;  // of what the first of them sends
  };
  bool enter(const void* owner, std::uint64_t size);  // null: nobody shares it
  void leave(const void* owner, std::uint64_t size);

  std::atomic<std::uint64_t> max_bytes_;
  std::mutex mutex_;  // guards what follows
  std::uint64_t bytes_ = 0;
  std::unordered_map<const void*, Shared> shared_;
};

}  // namespace vitrine
