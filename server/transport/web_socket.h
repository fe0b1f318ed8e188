// SPDX-License-Identifier: Apache-2.0
// One WebSocket [RFC6455] over a byte stream, as server or as client. Only web_socket.cpp includes
// Beast's WebSocket stream, whose templates are slow to compile.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/transport/byte_stream.h"

namespace vitrine::server {

struct WebSocketLimits {
  // Time limit for the handshake. Later, a peer that stays silent for this time is pinged, then
  // disconnected.
  std::chrono::seconds timeout{30};
  // Size of the largest message in bytes; a longer one from the peer ends the connection.
  std::size_t message = 64 * 1024;
};

// One read(), one write() and one close() may be pending at a time, all on the stream's strand.
class WebSocket {
 public:
  using Error = boost::system::error_code;
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Headers = std::vector<std::pair<boost::beast::http::field, std::string>>;
  using CloseReason = boost::beast::websocket::close_reason;
  enum class Opcode { kText, kBinary };
  struct Message {
    Error error;  // if set, no message was received
    Opcode opcode = Opcode::kText;
    boost::beast::flat_buffer bytes;

    std::span<const std::uint8_t> span() const;
  };
  struct Response {
    Error error;          // set if the connection failed before a response arrived
    unsigned status = 0;  // 101 if the connection is a WebSocket now
  };

  // `stream` must outlive this object.
  WebSocket(ByteStream& stream, WebSocketLimits limits);
  ~WebSocket();

  // Performs the server's handshake: answers `request`, and adds `headers` to the response.
  boost::asio::awaitable<Error> accept(Request request, Headers headers);
  // Performs the client's handshake. `host` is the value of the Host field: the host, and the port
  // if it is not the default.
  boost::asio::awaitable<Response> request_upgrade(std::string host, std::string target,
                                                   Headers headers);
  boost::asio::awaitable<Message> read();
  // Sends one message. The buffers must stay valid until the call completes.
  boost::asio::awaitable<Error> write(Opcode opcode,
                                      std::span<const boost::asio::const_buffer> buffers);
  boost::asio::awaitable<Error> close(CloseReason reason);

 private:
  struct Stream;
  const std::unique_ptr<Stream> stream_;
};

}  // namespace vitrine::server
