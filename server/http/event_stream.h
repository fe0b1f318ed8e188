// SPDX-License-Identifier: Apache-2.0
// Sends server-sent events (text/event-stream) from a source.
#pragma once

#include <chrono>
#include <string>

#include "server/http/connection.h"
#include "server/http/event_source.h"

namespace vitrine {

inline constexpr std::chrono::milliseconds kEventInterval{200};
inline constexpr std::chrono::seconds kHeartbeat{15};  // a comment where there was no event

// An event as it goes over the wire.
std::string event_text(const Event& event);

// Runs on the connection's strand, and returns the bytes sent once the source or the peer has
// ended, the peer has let `patience` pass without taking a byte, or the daemon stops.
asio::awaitable<std::uint64_t> send_events(Connection& connection, EventSource& source,
                                           std::chrono::seconds patience);

}  // namespace vitrine
