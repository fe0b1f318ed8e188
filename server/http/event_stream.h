// SPDX-License-Identifier: Apache-2.0
// Sends server-sent events [SSE] from a source.
#pragma once

#include <chrono>
#include <string>

#include "server/http/connection.h"
#include "server/messages/event_source.h"

namespace vitrine::server {

inline constexpr std::chrono::milliseconds kEventInterval{200};
// Interval of the keep-alive comments that are sent while no event occurs.
inline constexpr std::chrono::seconds kHeartbeat{15};

// Returns an event in the format text/event-stream.
std::string event_text(const Event& event);

// Sends events until the source ends, the peer disconnects, the peer accepts no byte for `timeout`,
// or the connection is asked to end. Runs on the connection's strand. Returns the number of bytes
// sent.
asio::awaitable<std::uint64_t> send_events(Connection& connection, EventSource& source,
                                           std::chrono::seconds timeout);

}  // namespace vitrine::server
