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

  // Admits a body for `network` (network_of()). The caller must keep the result until `body` is
  // sent. Returns null if the body does not fit in the memory limit. A text counts with its size.
  // Shared memory counts once in total, and once for each network that receives any of it.
  //
  // The bodies of a network may take a quarter of the limit. Its first body may be larger. The last
  // quarter of the limit is for networks whose bodies are modest in total, so that a few networks
  // cannot fill all of it.
  std::shared_ptr<const void> admit(const Body& body, const std::string& network);

  // Whether the body would be admitted if no other responses were being sent. A body that takes the
  // last quarter of the limit is never admitted, because one slow client could then keep the memory
  // from all others for hours.
  bool fits_alone(const Body& body) const {
    return body_memory(body) <= without_reserve(max_bytes_);
  }

  // Whether the body is modest: takes at most a 64th of the limit.
  bool is_modest(const Body& body) const { return is_modest(body_memory(body), max_bytes_); }

  // Whether the body counts. Bodies that occupy less than kSmall bytes of memory do not count.
  static bool counts(const Body& body) { return body_memory(body) >= kSmall; }

  static constexpr std::uint64_t kSmall = 16 * 1024;

 private:
  struct Shared {
    std::uint64_t bytes = 0;
    std::unordered_map<std::string, std::size_t> senders;  // number of bodies for each network
  };
  static bool is_modest(std::uint64_t size, std::uint64_t max) { return size <= max / 64; }
  static std::uint64_t without_reserve(std::uint64_t max) { return max - max / 4; }

  // `owner` is null if the memory is not shared.
  bool enter(const void* owner, std::uint64_t size, const std::string& network);
  void leave(const void* owner, std::uint64_t size, const std::string& network);
  // The caller of these functions must hold mutex_.
  bool has_room(std::uint64_t size, const std::string& network) const;
  void count_less(std::uint64_t size, const std::string& network);

  std::atomic<std::uint64_t> max_bytes_;
  std::mutex mutex_;  // guards the members below
  std::uint64_t bytes_ = 0;
  std::unordered_map<const void*, Shared> shared_;
  std::unordered_map<std::string, std::uint64_t> of_network_;  // bytes that each network receives
};

}  // namespace vitrine::server
