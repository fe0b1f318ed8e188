// SPDX-License-Identifier: Apache-2.0
// Connections that have become WebSockets: what pmesh.v1 needs of the rest of the daemon.
#pragma once

#include "server/http/http_server.h"
#include "server/stream/crowd.h"

namespace vitrine {

// What streams work with; it outlives them.
struct StreamHost {
  Services& services;
  Workers& workers;
  RateLimit& rate_limit;
  Crowd& crowd;
};

// Serves one until it ends. Each model is looked up by a worker, and each `open` costs a call of
// the visitor's rate limit.
asio::awaitable<void> stream(StreamCall call, StreamHost host);

}  // namespace vitrine
