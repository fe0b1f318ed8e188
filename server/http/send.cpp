// SPDX-License-Identifier: Apache-2.0
#include "server/http/send.h"

#include <sys/sendfile.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <iterator>

namespace vitrine::server {
namespace {

using Bytes = std::span<const std::uint8_t>;

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Computes the deadline by which the peer must accept more bytes.
class SendDeadline {
 public:
  SendDeadline(Connection& connection, Pace pace) : connection_(connection), pace_(pace) {}

  void renew(std::uint64_t sent) {
    connection_.expires_after(pace_.time_left(sent, Connection::Clock::now() - start_));
  }

 private:
  Connection& connection_;
  const Pace pace_;
  const Connection::Clock::time_point start_ = Connection::Clock::now();
};

// Waits until the socket accepts bytes. Returns false if the connection is closed.
asio::awaitable<bool> wait_writable(Connection& connection) {
  const auto [error] =
      co_await connection.socket.async_wait(ByteStream::Socket::wait_write, kNoThrow);
  co_return !error;
}

// Number of bytes that one connection may send before the thread serves other connections.
constexpr std::uint64_t kBurst = 4 << 20;

// Sends `size` bytes and returns how many were sent, which are fewer if the connection ends. Calls
// `write(sent)` to send bytes from offset `sent` on, until all are sent. `write` returns the number
// of bytes that the socket accepted, or -1 with errno set.
template <class Write>
asio::awaitable<std::uint64_t> send_all(Connection& connection, std::uint64_t size, Pace pace,
                                        Write write) {
  SendDeadline deadline(connection, pace);
  std::uint64_t sent = 0, pause = kBurst;
  while (sent < size) {
    if (sent >= pause) {
      co_await asio::post(connection.socket.get_executor(), kNoThrow);
      pause = sent + kBurst;
    }
    const ssize_t taken = write(sent);
    if (taken > 0) {
      sent += static_cast<std::uint64_t>(taken);
    } else if (taken == 0 || (errno != EAGAIN && errno != EINTR)) {
      break;
    } else if (errno == EAGAIN) {
      deadline.renew(sent);
      const bool writable = co_await wait_writable(connection);
      if (!writable) break;
    }
  }
  co_return sent;
}

asio::awaitable<std::uint64_t> send_encrypted(Connection& connection, Bytes bytes, Pace pace) {
  SendDeadline deadline(connection, pace);
  std::uint64_t sent = 0;
  while (sent < bytes.size()) {
    deadline.renew(sent);
    const Bytes left = bytes.subspan(sent);
    const auto [error, taken] = co_await connection.socket.async_write_some(
        asio::buffer(left.data(), left.size()), kNoThrow);
    if (error) break;
    sent += taken;
  }
  co_return sent;
}

asio::awaitable<std::uint64_t> send_memory(Connection& connection, Bytes bytes, int flags,
                                           Pace pace) {
  if (connection.socket.is_encrypted()) co_return co_await send_encrypted(connection, bytes, pace);
  const int socket = connection.socket.native_handle();
  auto write = [socket, bytes, flags](std::uint64_t sent) {
    return ::send(socket, bytes.data() + sent, bytes.size() - sent, flags | MSG_NOSIGNAL);
  };
  co_return co_await send_all(connection, bytes.size(), pace, write);
}

iovec part_of(Bytes bytes) {
  // Casts the constness away, because iovec has no const pointer. sendmsg() only reads the bytes.
  return {const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
}

// Sends `head` and then `body` from memory.
asio::awaitable<std::uint64_t> send_both(Connection& connection, Bytes head, Bytes body,
                                         Pace pace) {
  if (connection.socket.is_encrypted()) {
    const std::uint64_t sent = co_await send_encrypted(connection, head, pace);
    if (sent < head.size()) co_return sent;
    co_return sent + co_await send_encrypted(connection, body, pace);
  }
  const int socket = connection.socket.native_handle();
  auto write = [socket, head, body](std::uint64_t sent) {
    const std::size_t of_head = std::min<std::size_t>(sent, head.size());
    iovec parts[] = {part_of(head.subspan(of_head)), part_of(body.subspan(sent - of_head))};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = std::size(parts);
    return ::sendmsg(socket, &message, MSG_NOSIGNAL);
  };
  co_return co_await send_all(connection, head.size() + body.size(), pace, write);
}

asio::awaitable<std::uint64_t> send_file(Connection& connection, int file, const StoredBytes& body,
                                         Pace pace) {
  const int socket = connection.socket.native_handle();
  auto write = [socket, file, &body](std::uint64_t sent) {
    auto offset = static_cast<off_t>(body.offset + sent);
    return ::sendfile(socket, file, &offset, std::min(kBurst, body.length - sent));
  };
  co_return co_await send_all(connection, body.length, pace, write);
}

// Sends a stored object piece by piece. Used if the object has no file descriptor or the connection
// is encrypted, because sendfile(2) is then impossible.
asio::awaitable<std::uint64_t> send_pieces(Connection& connection, const StoredBytes& body,
                                           Pace pace) {
  constexpr std::uint64_t kPiece = 64 * 1024;
  std::uint64_t sent = 0;
  while (sent < body.length) {
    const auto piece = body.object->read(body.offset + sent, std::min(kPiece, body.length - sent));
    if (!piece) break;
    const std::uint64_t taken = co_await send_memory(connection, *piece, 0, pace);
    sent += taken;
    if (taken < piece->size()) break;
  }
  co_return sent;
}

asio::awaitable<std::uint64_t> send_stored(Connection& connection, const StoredBytes& body,
                                           Pace pace) {
  const auto file = body.object->descriptor();
  if (file && !connection.socket.is_encrypted()) {
    co_return co_await send_file(connection, *file, body, pace);
  }
  co_return co_await send_pieces(connection, body, pace);
}

}  // namespace

asio::awaitable<std::uint64_t> send_response(Connection& connection, std::string head, Body body,
                                             Pace pace) {
  connection.expires_after(pace.timeout);
  if (const auto* stored = std::get_if<StoredBytes>(&body)) {
    const int flags = stored->length > 0 ? MSG_MORE : 0;
    const std::uint64_t sent = co_await send_memory(connection, bytes_of(head), flags, pace);
    if (sent < head.size()) co_return 0;
    co_return co_await send_stored(connection, *stored, pace);
  }
  const auto* text = std::get_if<std::string>(&body);
  const Bytes bytes = text != nullptr ? bytes_of(*text) : std::get<SharedBytes>(body).bytes;
  const std::uint64_t sent = co_await send_both(connection, bytes_of(head), bytes, pace);
  co_return sent - std::min<std::uint64_t>(sent, head.size());
}

asio::awaitable<std::uint64_t> send_text(Connection& connection, std::string_view text, Pace pace) {
  connection.expires_after(pace.timeout);
  co_return co_await send_memory(connection, bytes_of(text), 0, pace);
}

}  // namespace vitrine::server
