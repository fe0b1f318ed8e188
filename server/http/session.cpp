// SPDX-License-Identifier: Apache-2.0
#include "server/http/session.h"

#include "server/http/dispatcher.h"
#include "server/http/request_reader.h"
#include "server/http/response_writer.h"
#include "server/http/upgrade.h"

namespace vitrine::server {
namespace {

constexpr std::chrono::seconds kLinger{2};

class Session {
 public:
  Session(std::shared_ptr<Connection> connection, HttpServer& server)
      : connection_(std::move(connection)), server_(server) {}

  asio::awaitable<void> run() {
    bool continues = true;
    while (continues && !connection_->is_draining)
      continues = co_await serve_one();
    if (writer_.is_at_end()) co_await linger();
    boost::system::error_code ignored;
    connection_->socket.close(ignored);
  }

 private:
  // Reads and answers one request. Returns false if the connection must end.
  asio::awaitable<bool> serve_one() {
    RequestParser parser;
    Exchange exchange;
    const ReadResult read = co_await reader_.read_header(parser, exchange);
    if (read == ReadResult::kClosed) co_return false;
    if (read == ReadResult::kRejected) dispatcher_.count_error(exchange);
    if (read == ReadResult::kRead) {
      const bool is_answered = co_await dispatcher_.dispatch(parser, exchange);
      if (!is_answered) {
        writer_.record(exchange, parser.get(), kUnanswered, 0);
        co_return false;
      }
    }
    // If part of the body is unread, the start of the next request is unknown, so the connection
    // must close.
    if (!parser.is_done() && !exchange.is_body_read) exchange.keeps_alive = false;
    if (exchange.response.upgrade && may_upgrade(parser, exchange)) {
      co_await upgrade(parser.release(), exchange);
      co_return false;
    }
    if (exchange.response.events) count_as_client(exchange);
    const bool is_sent = co_await writer_.write(parser.get(), exchange);
    co_return is_sent&& exchange.keeps_alive;
  }

  // Whether the connection may be upgraded. If not, sets an error response.
  bool may_upgrade(const RequestParser& parser, Exchange& exchange) {
    if (!parser.is_done()) {
      exchange.reject(400, "an upgrade has no body");
      return false;
    }
    return count_as_client(exchange);
  }

  // Counts the connection towards the limit of the client, even if a proxy has opened it. Call this
  // for a stream, because it serves one client for a long time. If the client has reached its
  // limit, sets an error response and returns false.
  bool count_as_client(Exchange& exchange) {
    if (server_.connections().count_as(*connection_, exchange.client.address)) return true;
    exchange.response = problem(429, "this address has too many streams", exchange.id);
    exchange.response.fields = {{"Retry-After", "5"}};
    return false;
  }

  asio::awaitable<void> upgrade(RequestParser::value_type request, Exchange& exchange) {
    const RequestHeader header = request.base();
    const std::shared_ptr<Upgrade> upgrade = std::move(exchange.response.upgrade);
    connection_->never_expires();
    server_.lasts_while(*connection_, exchange.caller,
                        [upgrade] { return upgrade->may_continue(); });
    reader_.release_buffer();
    // This variable has a name because g++ 12 destroys a braced temporary of a co_await twice.
    UpgradedConnection upgraded{connection_, std::move(request)};
    co_await upgrade->serve(std::move(upgraded), server_);
    writer_.record(exchange, header, 101, 0);
  }

  // For a short time, reads and discards what the peer sends. If the connection closed at once, the
  // peer's kernel might discard our response ([RFC9112] section 9.6).
  asio::awaitable<void> linger() {
    connection_->expires_after(kLinger);
    co_await connection_->socket.finish();
    boost::system::error_code error;
    std::array<char, 1024> dropped;
    while (!error) {
      std::tie(error, std::ignore) =
          co_await connection_->socket.async_read_some(asio::buffer(dropped), kNoThrow);
    }
  }

  const std::shared_ptr<Connection> connection_;
  HttpServer& server_;
  RequestReader reader_{*connection_, server_};
  Dispatcher dispatcher_{*connection_, server_, reader_};
  ResponseWriter writer_{*connection_, server_};
};

}  // namespace

asio::awaitable<void> run_session(std::shared_ptr<Connection> connection, HttpServer& server) {
  boost::system::error_code ignored;
  connection->socket.set_option(Tcp::no_delay(true), ignored);
  if (const auto& tls = server.options().tls) {
    connection->expires_after(server.pace().timeout);
    const auto error = co_await connection->socket.encrypt(tls->current());
    if (error) co_return;
  }
  Session session(connection, server);
  co_await session.run();
}

}  // namespace vitrine::server
