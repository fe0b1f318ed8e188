// SPDX-License-Identifier: Apache-2.0
// Reads requests from a connection: headers, JSON bodies, forms, and large bodies piece by piece.
#pragma once

#include <functional>
#include <span>

#include "server/http/exchange.h"
#include "server/http/http_server.h"

namespace vitrine::server {

using RequestParser = beast::http::request_parser<beast::http::string_body>;

enum class ReadResult {
  kRead,
  kRejected,  // the exchange contains the error response
  kClosed,    // the peer has disconnected, or the server drains
};

// Use this only on the connection's strand. Enforces all limits and timeouts of a request.
class RequestReader {
 public:
  // Receives a piece of the body; returns false to stop reading.
  using Consumer = std::function<asio::awaitable<bool>(std::span<const std::uint8_t> piece)>;

  RequestReader(Connection& connection, HttpServer& server)
      : connection_(connection), server_(server) {}

  asio::awaitable<ReadResult> read_header(RequestParser& parser, Exchange& exchange);

  // Reads the body as JSON into exchange.body. Rejects a body of more than `most` bytes.
  asio::awaitable<ReadResult> read_json(RequestParser& parser, Exchange& exchange,
                                        std::size_t most);

  // Reads the body as a form into exchange.form.
  asio::awaitable<ReadResult> read_form(RequestParser& parser, Exchange& exchange);

  // Passes the body to `consume` piece by piece. The parser keeps the request's header.
  asio::awaitable<ReadResult> read_pieces(RequestParser& parser, Exchange& exchange,
                                          Consumer consume);

  // Frees the buffer of a connection that is upgraded to another protocol.
  void release_buffer() { buffer_ = beast::flat_buffer(); }

 private:
  asio::awaitable<ReadResult> read_text(RequestParser& parser, Exchange& exchange,
                                        std::size_t most);
  asio::awaitable<ReadResult> meet_expectation(const RequestHeader& header, Exchange& exchange);
  ReadResult rejected(const boost::system::error_code& error, Exchange& exchange) const;

  // Limit on the buffer's size in bytes. Beast itself does not limit the size of the chunk
  // extensions in a chunked body ([RFC9112] section 7.1.1).
  static constexpr std::size_t kMaxBuffer = 64 * 1024;

  Connection& connection_;
  HttpServer& server_;
  beast::flat_buffer buffer_{kMaxBuffer};
};

}  // namespace vitrine::server
