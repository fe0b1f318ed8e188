// SPDX-License-Identifier: Apache-2.0
// The interface that receives a request body too large to keep in memory.
#pragma once

#include <optional>
#include <span>

#include "server/messages/response.h"

namespace vitrine::server {

// All functions are called on a worker thread, one call at a time.
class BodySink {
 public:
  virtual ~BodySink() = default;

  // Receives the next piece of the body. Returns nullopt to continue. Returns a response to end the
  // request; the rest of the body is then not read.
  virtual std::optional<Response> take(std::span<const std::uint8_t> piece) = 0;

  // Called after the last piece, unless take() has returned a response. The body may be incomplete
  // if the client has disconnected or the server is shutting down. Returns the response to the
  // request.
  virtual Response finish() = 0;
};

}  // namespace vitrine::server
