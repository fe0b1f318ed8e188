// SPDX-License-Identifier: Apache-2.0
#include "server/http/session.h"

#include <boost/beast/core/error.hpp>

#include "server/http/conditional.h"
#include "server/http/framing.h"
#include "server/http/problem.h"
#include "server/http/query.h"
#include "server/http/send.h"
#include "server/http/services.h"
#include "server/log/request_id.h"

namespace vitrine {
namespace {

using beast::http::field;
using beast::http::verb;
using Parser = beast::http::request_parser<beast::http::string_body>;

constexpr std::uint32_t kMaxHeader = 16 * 1024;
constexpr std::uint64_t kMaxBody = 64 * 1024;  // read and ignored: no route takes a body yet
constexpr std::size_t kMaxTarget = 8 * 1024;
constexpr std::size_t kMaxBuffer = 64 * 1024;  // the extensions of a chunked body have no limit
constexpr std::size_t kIdleBuffer = 4 * 1024;  // what a connection that waits may keep
constexpr std::chrono::seconds kLinger{2};

std::string_view text(beast::string_view view) {
  return {view.data(), view.size()};
}

// One request on its way to an answer.
struct Exchange {
  std::string id = next_request_id();
  Connection::Clock::time_point start = Connection::Clock::now();
  std::size_t route = SIZE_MAX;  // an index into the router's routes; past the end where none
  PathParameters parameters;
  Response response;
  bool keep_alive = true;
};

enum class ReadResult { kRequest, kRejected, kClosed };

unsigned status_of(const boost::system::error_code& error) {
  if (error == beast::http::error::header_limit) return 431;
  if (error == beast::http::error::body_limit) return 413;
  return 400;
}

Response preflight() {
  Response response;
  response.status = 204;
  response.fields = {{"Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"},
                     {"Access-Control-Allow-Headers", "If-None-Match, If-Range, Range"},
                     {"Access-Control-Max-Age", "86400"}};
  return response;
}

Response not_allowed(std::string_view id) {
  Response response = problem(405, "this resource can only be read", id);
  response.fields = {{"Allow", "GET, HEAD, OPTIONS"}};
  return response;
}

// The queue is full: it moves within seconds.
Response busy(std::string_view id) {
  Response response = problem(503, "", id);
  response.fields = {{"Retry-After", "5"}};
  return response;
}

class Session {
 public:
  Session(std::shared_ptr<Connection> connection, HttpServer& server)
      : connection_(std::move(connection)), server_(server) {}

  asio::awaitable<void> run() {
    bool goes_on = true;
    while (goes_on && !connection_->draining)
      goes_on = co_await serve_one();
    if (lingers_) co_await linger();
    close();
  }

 private:
  // Reads and answers one request. False where the connection is to end.
  asio::awaitable<bool> serve_one() {
    Parser parser;
    parser.header_limit(kMaxHeader);
    parser.body_limit(kMaxBody);
    Exchange exchange;
    const ReadResult result = co_await read(parser, exchange);
    if (result == ReadResult::kClosed) co_return false;
    if (result == ReadResult::kRequest) {
      const Route* route = find_route(parser.get(), exchange);
      if (route != nullptr) co_await answer(*route, parser.get(), exchange);
    }
    if (exchange.response.status == 101) {
      co_await stream(parser.release(), exchange);
      co_return false;
    }
    const bool sent = co_await send(parser.get(), exchange);
    co_return sent ? exchange.keep_alive : false;
  }

  asio::awaitable<ReadResult> read(Parser& parser, Exchange& exchange) {
    connection_->expires_after(server_.options().patience);
    connection_->idle = buffer_.size() == 0;
    if (connection_->idle && buffer_.capacity() > kIdleBuffer) buffer_.shrink_to_fit();
    const auto [error, bytes] =
        co_await beast::http::async_read_header(connection_->socket, buffer_, parser, kNoThrow);
    connection_->idle = false;
    exchange.start = Connection::Clock::now();
    if (error) co_return rejected(error, exchange);
    exchange.keep_alive = parser.keep_alive();
    if (const auto fault = framing_fault(parser.get()); !fault.empty()) {
      reject(exchange, 400, fault);
      co_return ReadResult::kRejected;
    }
    if (parser.is_done()) co_return ReadResult::kRequest;
    const ReadResult skipped = co_await skip_body(parser, exchange);
    co_return skipped;
  }

  asio::awaitable<ReadResult> skip_body(Parser& parser, Exchange& exchange) {
    if (parser.get().count(field::expect) > 0) {
      reject(exchange, 417, "no resource here takes a body");
      co_return ReadResult::kRejected;
    }
    const auto [error, bytes] =
        co_await beast::http::async_read(connection_->socket, buffer_, parser, kNoThrow);
    co_return error ? rejected(error, exchange) : ReadResult::kRequest;
  }

  // Answers and closes: where the next request would start is unknown.
  void reject(Exchange& exchange, unsigned status, std::string_view detail) {
    exchange.response = problem(status, detail, exchange.id);
    exchange.keep_alive = false;
  }

  // The peer's goodbye, or a request that is none.
  ReadResult rejected(const boost::system::error_code& error, Exchange& exchange) {
    const bool grammar =
        error.category() == make_error_code(beast::http::error::bad_method).category();
    if (!grammar || error == beast::http::error::end_of_stream ||
        error == beast::http::error::partial_message) {
      return ReadResult::kClosed;
    }
    reject(exchange, status_of(error), "the request is malformed or too large");
    return ReadResult::kRejected;
  }

  // Null where the answer is known already.
  const Route* find_route(const Parser::value_type& request, Exchange& exchange) {
    const auto target = split_target(text(request.target()));
    if (!target || request.target().size() > kMaxTarget) {
      reject(exchange, target ? 414 : 400, "the target is not a path");
      return nullptr;
    }
    const auto match = server_.router().match(target->path);
    if (!match) {
      exchange.response = problem(404, "there is nothing at this path", exchange.id);
      return nullptr;
    }
    exchange.route = match->index;
    exchange.parameters = match->parameters;
    if (request.method() == verb::get || request.method() == verb::head) {
      return &server_.router().routes()[match->index];
    }
    exchange.response = request.method() == verb::options ? preflight() : not_allowed(exchange.id);
    return nullptr;
  }

  asio::awaitable<void> answer(const Route& route, const Parser::value_type& message,
                               Exchange& exchange) {
    const auto target = split_target(text(message.target()));
    const Request request{message, target->path, target->query, exchange.parameters, exchange.id};
    if (route.quick != nullptr) {
      if (auto quick = route.quick(request, server_.services())) {
        exchange.response = apply_conditions(message, std::move(*quick), exchange.id);
        co_return;
      }
    }
    const auto handle = [&] {
      return apply_conditions(message, guarded(route.handler, request), exchange.id);
    };
    if (route.place == Place::kInline) {
      exchange.response = handle();
      co_return;
    }
    const auto seat = server_.workers().reserve(route.place);
    if (!seat) {
      exchange.response = busy(exchange.id);
      co_return;
    }
    connection_->never_expires();
    const auto executor = server_.workers().executor(route.place, text(message.target()));
    auto work = [&]() -> asio::awaitable<void> {
      exchange.response = handle();
      co_return;
    };
    co_await asio::co_spawn(executor, work, asio::use_awaitable);
  }

  // A handler that throws (out of memory, a JSON library's surprise) costs its request alone.
  Response guarded(Handler handler, const Request& request) {
    try {
      return handler(request, server_.services());
    } catch (const std::exception& fault) {
      server_.services().errors.event(
          Severity::kError,
          std::string("request ") + std::string(request.id) + ": " + fault.what());
      return problem(500, "", request.id);
    }
  }

  asio::awaitable<void> stream(Parser::value_type request, Exchange& exchange) {
    const std::string target(request.target());
    connection_->never_expires();
    StreamCall call{connection_, std::move(request), exchange.parameters.id, exchange.id};
    buffer_ = beast::flat_buffer();
    co_await server_.options().stream(std::move(call));
    record(exchange, "GET", target, 101, 0);
  }

  // False where the peer did not take all of it.
  asio::awaitable<bool> send(const Parser::value_type& request, Exchange& exchange) {
    if (connection_->draining) exchange.keep_alive = false;
    Response& response = exchange.response;
    const HeadOptions options{exchange.id, exchange.keep_alive, request.version()};
    std::string head = response_head(response, options);
    const unsigned status = response.status;
    const bool with_body = request.method() != verb::head;
    Body body = with_body ? std::move(response.body) : Body();
    const std::uint64_t size = body_size(body);
    const std::uint64_t sent = co_await send_response(*connection_, std::move(head),
                                                      std::move(body), server_.options().patience);
    record(exchange, text(request.method_string()), text(request.target()), status, sent);
    const bool last = !exchange.keep_alive || connection_->draining;
    lingers_ = sent == size && last;
    co_return sent == size;
  }

  void record(const Exchange& exchange, std::string_view method, std::string_view target,
              unsigned status, std::uint64_t bytes) {
    if (!server_.options().recorded) return;
    const auto routes = server_.router().routes();
    const std::chrono::duration<double> seconds = Connection::Clock::now() - exchange.start;
    server_.services().metrics.request(exchange.route, status, bytes, seconds.count());
    server_.services().log.access(
        {.request_id = exchange.id,
         .remote = connection_->remote,
         .method = method,
         .route = exchange.route < routes.size() ? routes[exchange.route].path : "-",
         .target = target,
         .status = status,
         .bytes = bytes,
         .seconds = seconds.count()});
  }

  // Closing while the peer still sends would reset the connection, and the peer might lose our
  // answer: what it sends is read and dropped for a moment.
  asio::awaitable<void> linger() {
    boost::system::error_code error;
    connection_->socket.shutdown(Tcp::socket::shutdown_send, error);
    connection_->expires_after(kLinger);
    std::array<char, 1024> dropped;
    while (!error) {
      std::tie(error, std::ignore) =
          co_await connection_->socket.async_read_some(asio::buffer(dropped), kNoThrow);
    }
  }

  void close() {
    boost::system::error_code ignored;
    connection_->socket.close(ignored);
  }

  std::shared_ptr<Connection> connection_;
  HttpServer& server_;
  beast::flat_buffer buffer_{kMaxBuffer};
  bool lingers_ = false;
};

}  // namespace

asio::awaitable<void> run_session(std::shared_ptr<Connection> connection, HttpServer& server) {
  boost::system::error_code ignored;
  connection->socket.set_option(Tcp::no_delay(true), ignored);
  connection->socket.non_blocking(true, ignored);
  connection->remote = connection->socket.remote_endpoint(ignored).address().to_string();
  Session session(connection, server);
  co_await session.run();
}

}  // namespace vitrine
