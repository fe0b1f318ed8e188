// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_stream.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <cerrno>

#include "server/http/send.h"

namespace vitrine::server {
namespace {

// Whether the peer has disconnected. The caller must poll this function, because no read is pending
// that would report the disconnection. Bytes that the peer has sent stay in the socket.
bool has_left(Connection& connection) {
  char byte;
  const ssize_t count =
      ::recv(connection.socket.native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

}  // namespace

std::string event_text(const Event& event) {
  return fmt::format("event: {}\nid: {}\ndata: {}\n\n", event.name, event.id, event.data);
}

asio::awaitable<std::uint64_t> send_events(Connection& connection, EventSource& source,
                                           std::chrono::seconds timeout) {
  const auto tick = std::make_shared<asio::steady_timer>(connection.socket.get_executor());
  connection.on_drain = [tick] { tick->cancel(); };
  auto spoke = Connection::Clock::now();
  std::uint64_t total = 0;
  while (!connection.is_draining && !has_left(connection)) {
    std::string text;
    if (const auto event = source.next()) text = event_text(*event);
    if (text.empty() && Connection::Clock::now() - spoke >= kHeartbeat) text = ":\n\n";
    if (!text.empty()) {
      const std::uint64_t sent = co_await send_text(connection, text, {.timeout = timeout});
      total += sent;
      if (sent < text.size()) break;
      spoke = Connection::Clock::now();
    }
    if (source.ended()) break;
    connection.never_expires();
    tick->expires_after(kEventInterval);
    co_await tick->async_wait(kNoThrow);
  }
  connection.on_drain = nullptr;
  co_return total;
}

}  // namespace vitrine::server
