// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_reader.h"

#include <boost/beast/core/error.hpp>

#include "server/messages/framing.h"
#include "server/messages/request_body.h"

namespace vitrine::server {
namespace {

using beast::http::field;
using PieceParser = beast::http::request_parser<beast::http::buffer_body>;

constexpr std::uint32_t kMaxHeader = 16 * 1024;
constexpr std::size_t kBodyPiece = 64 * 1024;
// Size in bytes of the largest buffer that an idle connection keeps.
constexpr std::size_t kIdleBuffer = 4 * 1024;

std::string_view media_type_of(const RequestHeader& header) {
  const auto type = header[field::content_type];
  return {type.data(), type.size()};
}

unsigned status_of(const boost::system::error_code& error) {
  if (error == beast::http::error::header_limit) return 431;
  if (error == beast::http::error::body_limit) return 413;
  return 400;
}

// Moves the request's header back from `from`, which has read the body in pieces. Code that makes
// the response needs the header.
void give_header_back(PieceParser& from, RequestParser& to) {
  to.get().base() = std::move(from.get().base());
}

}  // namespace

asio::awaitable<ReadResult> RequestReader::read_header(RequestParser& parser, Exchange& exchange) {
  parser.header_limit(kMaxHeader);
  parser.body_limit(boost::none);  // read_text() sets the limit
  connection_.expires_after(server_.pace().timeout);
  connection_.is_idle = buffer_.size() == 0;
  if (connection_.is_idle && buffer_.capacity() > kIdleBuffer) buffer_.shrink_to_fit();
  const auto [error, bytes] =
      co_await beast::http::async_read_header(connection_.socket, buffer_, parser, kNoThrow);
  connection_.is_idle = false;
  exchange.start = Connection::Clock::now();
  exchange.client = {connection_.remote, connection_.socket.is_encrypted()};
  if (error) co_return rejected(error, exchange);
  exchange.keeps_alive = parser.keep_alive();
  exchange.client = client_of(std::move(exchange.client), parser.get(), server_.options().proxies);
  if (const auto fault = framing_fault(parser.get()); !fault.empty()) {
    exchange.reject(400, fault);
    co_return ReadResult::kRejected;
  }
  co_return ReadResult::kRead;
}

asio::awaitable<ReadResult> RequestReader::read_json(RequestParser& parser, Exchange& exchange,
                                                     std::size_t most) {
  const ReadResult read = co_await read_text(parser, exchange, most);
  if (read != ReadResult::kRead) co_return read;
  auto body = parse_body(media_type_of(parser.get()), parser.get().body(), most);
  if (!body) {
    exchange.response = problem(body.error().status, body.error().detail, exchange.id);
    co_return ReadResult::kRejected;
  }
  exchange.body = std::move(*body);
  co_return ReadResult::kRead;
}

asio::awaitable<ReadResult> RequestReader::read_form(RequestParser& parser, Exchange& exchange) {
  const ReadResult read = co_await read_text(parser, exchange, kMaxRequestBody);
  if (read != ReadResult::kRead) co_return read;
  if (const auto fault = form_fault(media_type_of(parser.get()), parser.get().body())) {
    exchange.response = problem(fault->status, fault->detail, exchange.id);
    co_return ReadResult::kRejected;
  }
  exchange.form = std::move(parser.get().body());
  co_return ReadResult::kRead;
}

asio::awaitable<ReadResult> RequestReader::read_text(RequestParser& parser, Exchange& exchange,
                                                     std::size_t most) {
  if (parser.is_done()) co_return ReadResult::kRead;
  connection_.expires_after(server_.pace().timeout);
  if (parser.content_length().value_or(0) > most) {
    exchange.reject(413, "the body is too large");
    co_return ReadResult::kRejected;
  }
  parser.body_limit(most);  // limit for a chunked body, which states no length
  const ReadResult expected = co_await meet_expectation(parser.get(), exchange);
  if (expected != ReadResult::kRead) co_return expected;
  connection_.reads_body = true;
  const auto [error, bytes] =
      co_await beast::http::async_read(connection_.socket, buffer_, parser, kNoThrow);
  connection_.reads_body = false;
  if (error == asio::error::operation_aborted && connection_.socket.is_open()) {
    exchange.reject(408, "the body did not arrive in time");
    co_return ReadResult::kRejected;
  }
  co_return error ? rejected(error, exchange) : ReadResult::kRead;
}

asio::awaitable<ReadResult> RequestReader::read_pieces(RequestParser& parser, Exchange& exchange,
                                                       Consumer consume) {
  if (parser.is_done()) co_return ReadResult::kRead;
  const ReadResult expected = co_await meet_expectation(parser.get(), exchange);
  if (expected != ReadResult::kRead) co_return expected;
  PieceParser pieces(std::move(parser));
  std::vector<std::uint8_t> piece(kBodyPiece);
  bool has_failed = false, is_wanted = true;
  while (is_wanted && !has_failed && !pieces.is_done()) {
    auto& body = pieces.get().body();
    body.data = piece.data();
    body.size = piece.size();
    connection_.expires_after(server_.pace().timeout);
    const auto [error, bytes] =
        co_await beast::http::async_read(connection_.socket, buffer_, pieces, kNoThrow);
    has_failed = (error && error != beast::http::error::need_buffer) || connection_.is_draining;
    const std::size_t size = piece.size() - body.size;
    if (size > 0) is_wanted = co_await consume(std::span(piece).first(size));
  }
  exchange.is_body_read = pieces.is_done();
  give_header_back(pieces, parser);
  co_return has_failed && !exchange.is_body_read ? ReadResult::kClosed : ReadResult::kRead;
}

// Handles a request with `Expect: 100-continue`: sends the interim response for which the client
// waits before it sends the body.
asio::awaitable<ReadResult> RequestReader::meet_expectation(const RequestHeader& header,
                                                            Exchange& exchange) {
  if (header.count(field::expect) == 0) co_return ReadResult::kRead;
  if (!beast::iequals(header[field::expect], "100-continue")) {
    exchange.reject(417, "the only Expect value supported is 100-continue");
    co_return ReadResult::kRejected;
  }
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  const std::uint64_t sent =
      co_await send_text(connection_, kContinue, {.timeout = server_.pace().timeout});
  co_return sent < kContinue.size() ? ReadResult::kClosed : ReadResult::kRead;
}

// Returns the result of a read that failed with `error`: kRejected with an error response if the
// request is malformed or too large, else kClosed.
ReadResult RequestReader::rejected(const boost::system::error_code& error,
                                   Exchange& exchange) const {
  const bool is_grammar =
      error.category() == make_error_code(beast::http::error::bad_method).category();
  if (!is_grammar || error == beast::http::error::end_of_stream ||
      error == beast::http::error::partial_message) {
    return ReadResult::kClosed;
  }
  exchange.reject(status_of(error), "the request is malformed or too large");
  return ReadResult::kRejected;
}

}  // namespace vitrine::server
