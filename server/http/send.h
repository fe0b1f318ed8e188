// SPDX-License-Identifier: Apache-2.0
// Sends the head and the body of a response.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "server/http/connection.h"
#include "server/messages/response.h"

namespace vitrine::server {

// Limits on how slowly a peer may receive.
struct Pace {
  std::chrono::seconds timeout;  // time within which the peer must accept a byte
  // Minimum average rate in bytes per second, enforced once `timeout` has passed; 0: no minimum.
  std::uint32_t min_rate = 0;

  // Returns the time within which the peer must accept more bytes, if it accepted `sent` bytes in
  // the time `elapsed`. It is `timeout`, or less if the minimum rate requires it. A peer that is
  // too slow has no time left (zero or less).
  std::chrono::nanoseconds time_left(std::uint64_t sent, std::chrono::nanoseconds elapsed) const {
    if (min_rate == 0) return timeout;
    const auto allowed = timeout + std::chrono::milliseconds(sent * 1000 / min_rate);
    return std::min<std::chrono::nanoseconds>(timeout, allowed - elapsed);
  }
};

// Sends a response. Returns the number of body bytes sent, which is less than body_size(body) if
// the peer disconnected or is too slow. Memory per connection does not grow with the body. A stored
// file is sent with sendfile(2), or piece by piece if the connection is encrypted.
asio::awaitable<std::uint64_t> send_response(Connection& connection, std::string head, Body body,
                                             Pace pace);

// Sends a text, which the caller must keep alive. Returns the number of bytes sent.
asio::awaitable<std::uint64_t> send_text(Connection& connection, std::string_view text, Pace pace);

}  // namespace vitrine::server
