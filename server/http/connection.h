// SPDX-License-Identifier: Apache-2.0
// One visitor's socket and what others may do to it: cut it when its time is up, or ask it to end.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>

#include "server/http/beast.h"
#include "server/transport/byte_stream.h"

namespace vitrine {

// Everything but `deadline` belongs to the socket's strand.
struct Connection : std::enable_shared_from_this<Connection> {
  using Clock = std::chrono::steady_clock;

  explicit Connection(ByteStream::Socket s) : socket(std::move(s)), remote(socket.peer_address()) {}

  ByteStream socket;
  const std::string remote;  // the peer's address, or "unix"
  std::string counted_as;    // ConnectionSet's: the network whose limit it counts for
  bool idle = false;         // between two requests: may be closed without loss
  bool reads_body = false;   // is told of its deadline before it is cut: it has an answer to give
  bool draining = false;     // the answer under way is the last one
  std::function<void()> on_drain;  // how an upgraded connection says goodbye; empty before

  // The sweeper closes the socket once this has passed; one store per step is all it costs.
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

}  // namespace vitrine
