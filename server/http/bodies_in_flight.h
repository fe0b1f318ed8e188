// SPDX-License-Identifier: Apache-2.0
// Limits the memory of responses that are being sent, because slow clients can occupy it for a long
// time.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "server/messages/body.h"

namespace vitrine::server {

// Thread-safe. Must be owned by a shared pointer, because the results of admit() keep it alive.
class BodiesInFlight : public std::enable_shared_from_this<BodiesInFlight> {
 public:
  // `max_bytes`: limit on the total size of the responses being sent.
  explicit BodiesInFlight(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void set_capacity(std::uint64_t max_bytes) { max_bytes_ = max_bytes; }

  // Admits a body for a client in `network` (network_of()). The caller must keep the result until
  // `body` is sent. Returns null if `body` and all bodies being sent exceed the memory limit, or
  // half of the limit if a counted body is already being sent to the same network. A std::string
  // counts with its size. SharedBytes count once, even if several connections send them.
  // StoredBytes, static memory and bodies smaller than kSmall bytes do not count.
  std::shared_ptr<const void> admit(const Body& body, const std::string& network);

  // Whether the body would be admitted if no other responses were being sent.
  bool fits_alone(const Body& body) const { return body_size(body) <= max_bytes_; }

  static constexpr std::uint64_t kSmall = 16 * 1024;

 private:
  struct Shared {
    std::size_t senders = 0;
    std::uint64_t bytes = 0;  // bytes counted for this memory: the size of the first sender's body
    std::string network;      // the first sender's network
  };
  // `owner` is null if the memory is not shared.
  bool enter(const void* owner, std::uint64_t size, const std::string& network);
  void leave(const void* owner, std::uint64_t size, const std::string& network);
  void release(std::uint64_t size, const std::string& network);

  std::atomic<std::uint64_t> max_bytes_;
  std::mutex mutex_;  // guards the members below
  std::uint64_t bytes_ = 0;
  std::unordered_map<const void*, Shared> shared_;
  // Number of counted bodies of each network.
  std::unordered_map<std::string, std::size_t> counted_;
};

}  // namespace vitrine::server
