// SPDX-License-Identifier: Apache-2.0
// Sends a response's head and body.
#pragma once

#include <chrono>

#include "server/http/connection.h"
#include "server/http/response.h"

namespace vitrine {

// Returns the body bytes sent; fewer than body_size(body) where the peer went away or let
// `patience` pass without taking a byte. Memory per connection does not grow with the body: what is
// stored in a file goes by sendfile(2).
asio::awaitable<std::uint64_t> send_response(Connection& connection, std::string head, Body body,
                                             std::chrono::seconds patience);

// Returns the bytes of `text` sent, on the same terms. `text` must live until then.
asio::awaitable<std::uint64_t> send_text(Connection& connection, std::string_view text,
                                         std::chrono::seconds patience);

}  // namespace vitrine
