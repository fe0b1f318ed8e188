// SPDX-License-Identifier: Apache-2.0
#include "server/transport/web_socket.h"

#include <boost/beast/websocket/stream.hpp>

#include "server/transport/no_throw.h"

namespace vitrine::server {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

// Returns a decorator that adds `headers` to the request or the response of the handshake.
auto adding(WebSocket::Headers headers) {
  return websocket::stream_base::decorator([headers = std::move(headers)](auto& message) {
    for (const auto& [field, value] : headers)
      message.set(field, value);
  });
}

}  // namespace

struct WebSocket::Stream {
  explicit Stream(ByteStream& stream) : socket(stream) {}

  websocket::stream<ByteStream&, /*deflate=*/false> socket;
};

std::span<const std::uint8_t> WebSocket::Message::span() const {
  const auto data = bytes.cdata();
  return {static_cast<const std::uint8_t*>(data.data()), data.size()};
}

WebSocket::WebSocket(ByteStream& stream, WebSocketLimits limits)
    : stream_(std::make_unique<Stream>(stream)) {
  websocket::stream_base::timeout timeout;
  timeout.handshake_timeout = limits.timeout;
  timeout.idle_timeout = limits.timeout;
  timeout.keep_alive_pings = true;
  stream_->socket.set_option(timeout);
  stream_->socket.read_message_max(limits.message);
  stream_->socket.auto_fragment(false);
}

WebSocket::~WebSocket() = default;

asio::awaitable<WebSocket::Error> WebSocket::accept(Request request, Headers headers) {
  stream_->socket.set_option(adding(std::move(headers)));
  const auto [error] = co_await stream_->socket.async_accept(request, kNoThrow);
  co_return error;
}

asio::awaitable<WebSocket::Response> WebSocket::request_upgrade(std::string host,
                                                                std::string target,
                                                                Headers headers) {
  stream_->socket.set_option(adding(std::move(headers)));
  http::response<http::string_body> answer;
  const auto [error] = co_await stream_->socket.async_handshake(answer, host, target, kNoThrow);
  if (error && error != websocket::error::upgrade_declined) co_return Response{.error = error};
  co_return Response{.error = {}, .status = answer.result_int()};
}

asio::awaitable<WebSocket::Message> WebSocket::read() {
  Message message;
  const auto [error, bytes] = co_await stream_->socket.async_read(message.bytes, kNoThrow);
  message.error = error;
  message.opcode = stream_->socket.got_text() ? Opcode::kText : Opcode::kBinary;
  co_return message;
}

asio::awaitable<WebSocket::Error> WebSocket::write(Opcode opcode,
                                                   std::span<const asio::const_buffer> buffers) {
  stream_->socket.text(opcode == Opcode::kText);
  const auto [error, bytes] = co_await stream_->socket.async_write(buffers, kNoThrow);
  co_return error;
}

asio::awaitable<WebSocket::Error> WebSocket::close(CloseReason reason) {
  const auto [error] = co_await stream_->socket.async_close(reason, kNoThrow);
  co_return error;
}

}  // namespace vitrine::server
