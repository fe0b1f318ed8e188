// SPDX-License-Identifier: Apache-2.0
// Sends a response's head and body.
#pragma once

#include <chrono>

#include "server/http/connection.h"
#include "server/http/response.h"

namespace vitrine {

// How slow a peer may be.
struct Pace {
  std::chrono::seconds patience;  // to take a byte
  std::uint32_t min_rate = 0;     // bytes a second on average, once `patience` is over; 0: any
};

// Returns the body bytes sent; fewer than body_size(body) where the peer went away or is too slow.
// Memory per connection does not grow with the body: what is stored in a file goes by sendfile(2),
// but where it is encrypted.
asio::awaitable<std::uint64_t> send_response(Connection& connection, std::string head, Body body,
                                             Pace pace);

// Returns the bytes of `text` sent, on the same terms. `text` must live until then.
asio::awaitable<std::uint64_t> send_text(Connection& connection, std::string_view text, Pace pace);

}  // namespace vitrine
