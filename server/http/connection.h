// SPDX-License-Identifier: Apache-2.0
// A connection: a socket, its deadline, and the state that the server needs to shut down.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>

#include "server/http/beast.h"
#include "server/transport/byte_stream.h"

namespace vitrine::server {

// All members except `deadline` may be used only on the socket's strand.
struct Connection : std::enable_shared_from_this<Connection> {
  using Clock = std::chrono::steady_clock;

  explicit Connection(ByteStream::Socket s) : socket(std::move(s)), remote(socket.peer_address()) {}

  ByteStream socket;
  const std::string remote;  // the peer's address, or "unix"
  // The network whose limit this connection counts towards; set by ConnectionSet.
  std::string counted_as;
  // Whether the connection is between two requests and can be closed without losing data.
  bool is_idle = false;
  // Whether a body is being read. In this case, the deadline cancels only the read, so that the
  // server can still send a response.
  bool reads_body = false;
  bool is_draining = false;  // whether the connection must close after the current response
  // Called to end a WebSocket or an event stream; empty for other responses.
  std::function<void()> on_drain;

  // Sets the deadline after which ConnectionSet::sweep() closes the socket or, if a body is being
  // read, cancels the read. Costs one atomic store.
  void expires_after(Clock::duration time) {
    deadline.store((Clock::now() + time).time_since_epoch().count(), std::memory_order_relaxed);
  }
  void never_expires() { deadline.store(kNever, std::memory_order_relaxed); }
  bool expired() const {
    return deadline.load(std::memory_order_relaxed) < Clock::now().time_since_epoch().count();
  }

 private:
  static constexpr Clock::rep kNever = Clock::duration::max().count();
  std::atomic<Clock::rep> deadline{kNever};
};

}  // namespace vitrine::server
