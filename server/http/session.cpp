// SPDX-License-Identifier: Apache-2.0
#include "server/http/session.h"

#include <boost/beast/core/error.hpp>

#include "server/http/authorise.h"
#include "server/http/body_sink.h"
#include "server/http/conditional.h"
#include "server/http/event_stream.h"
#include "server/http/framing.h"
#include "server/http/handlers.h"
#include "server/http/problem.h"
#include "server/http/query.h"
#include "server/http/request_body.h"
#include "server/http/send.h"
#include "server/http/services.h"
#include "server/http/visitor.h"
#include "server/log/request_id.h"

namespace vitrine {
namespace {

using beast::http::field;
using beast::http::verb;
using Parser = beast::http::request_parser<beast::http::string_body>;
using PieceParser = beast::http::request_parser<beast::http::buffer_body>;

constexpr std::uint32_t kMaxHeader = 16 * 1024;
constexpr std::size_t kMaxTarget = 8 * 1024;
constexpr std::size_t kMaxBuffer = 64 * 1024;  // the extensions of a chunked body have no limit
constexpr std::size_t kPiece = 64 * 1024;      // of a body that goes to a sink
constexpr std::size_t kIdleBuffer = 4 * 1024;  // what a connection that waits may keep
constexpr std::chrono::seconds kLinger{2};
constexpr unsigned kUnanswered = 499;  // in the logs: the peer has gone, whatever was done by then

std::string_view text(beast::string_view view) {
  return {view.data(), view.size()};
}

// One request on its way to an answer.
struct Exchange {
  std::string id = next_request_id();
  Connection::Clock::time_point start = Connection::Clock::now();
  std::size_t route_template = SIZE_MAX;  // an index into the router's; past the end where none
  PathParameters parameters;
  const Route* route = nullptr;  // null where the answer is known without one
  std::optional<Caller> caller;
  nlohmann::json body = nlohmann::json::object();
  Response response;
  bool keep_alive = true;
  bool has_poured = false;  // the whole body, into a sink
  bool public_read = true;
  Visitor visitor;
};

enum class ReadResult { kRequest, kRejected, kClosed };

unsigned status_of(const boost::system::error_code& error) {
  if (error == beast::http::error::header_limit) return 431;
  if (error == beast::http::error::body_limit) return 413;
  return 400;
}

std::optional<Method> method_of(verb method) {
  switch (method) {
    case verb::get:
    case verb::head:
      return Method::kGet;
    case verb::post:
      return Method::kPost;
    case verb::patch:
      return Method::kPatch;
    case verb::delete_:
      return Method::kDelete;
    case verb::options:
      return Method::kOptions;
    default:
      return std::nullopt;
  }
}

// What a path takes; pages of other origins may read it where everybody may, and do nothing else.
Response options(std::string allow, bool public_read) {
  Response response;
  response.status = 204;
  response.fields = {{"Allow", std::move(allow)}};
  if (public_read) {
    response.fields.insert(response.fields.end(),
                           {{"Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"},
                            {"Access-Control-Allow-Headers", "If-None-Match, If-Range, Range"},
                            {"Access-Control-Max-Age", "86400"}});
  }
  return response;
}

Response not_allowed(std::string allow, std::string_view id) {
  Response response = problem(405, "the path does not take this method", id);
  response.fields = {{"Allow", std::move(allow)}};
  return response;
}

Response no_room(bool will_be, std::string_view id) {
  if (will_be) return away(id);
  return problem(507, "the answer is larger than answer-memory allows; ask for a coarser level",
                 id);
}

Response no_seat(Seats::Refusal why, std::string_view id) {
  if (why == Seats::Refusal::kFull) return away(id);  // it moves within seconds
  Response response = problem(429, "this address has enough under way; wait", id);
  response.fields = {{"Retry-After", "5"}};
  return response;
}

bool changes(Method method) {
  return method != Method::kGet && method != Method::kOptions;
}

bool takes_json(const Route& route) {
  return route.reads_body && (route.method == Method::kPost || route.method == Method::kPatch);
}

// Answers are made of the request's header, which the parser of the pieces has taken.
void give_header_back(PieceParser& from, Parser& to) {
  to.get().base() = std::move(from.get().base());
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
    parser.body_limit(boost::none);  // receive_body() sets one
    Exchange exchange;
    const ReadResult result = co_await read_header(parser, exchange);
    if (result == ReadResult::kClosed) co_return false;
    if (result == ReadResult::kRequest) {
      find_route(parser.get(), exchange);
      if (exchange.route != nullptr) {
        const bool answered = co_await answer(parser, exchange);
        if (!answered) {
          record(exchange, text(parser.get().method_string()), text(parser.get().target()),
                 kUnanswered, 0);
          co_return false;
        }
      }
    }
    // A body that nobody has read: where the next request would start is unknown.
    if (!parser.is_done() && !exchange.has_poured) exchange.keep_alive = false;
    if (exchange.response.status == 101) check_upgrade(parser, exchange);
    if (exchange.response.status == 101) {
      co_await stream(parser.release(), exchange);
      co_return false;
    }
    const bool sent = co_await send(parser.get(), exchange);
    co_return sent ? exchange.keep_alive : false;
  }

  asio::awaitable<ReadResult> read_header(Parser& parser, Exchange& exchange) {
    connection_->expires_after(server_.pace().patience);
    connection_->idle = buffer_.size() == 0;
    if (connection_->idle && buffer_.capacity() > kIdleBuffer) buffer_.shrink_to_fit();
    const auto [error, bytes] =
        co_await beast::http::async_read_header(connection_->socket, buffer_, parser, kNoThrow);
    connection_->idle = false;
    exchange.start = Connection::Clock::now();
    if (error) co_return rejected(error, exchange);
    exchange.keep_alive = parser.keep_alive();
    exchange.visitor = visitor_of({connection_->remote, connection_->socket.is_encrypted()},
                                  parser.get(), server_.options().proxies);
    if (const auto fault = framing_fault(parser.get()); !fault.empty()) {
      reject(exchange, 400, fault);
      co_return ReadResult::kRejected;
    }
    co_return ReadResult::kRequest;
  }

  // Takes the request's body, where it has one: from callers alone that may send it.
  asio::awaitable<ReadResult> read_body(Parser& parser, Exchange& exchange) {
    if (!parser.is_done()) {
      connection_->expires_after(server_.pace().patience);
      const ReadResult read = co_await receive_body(parser, exchange);
      if (read != ReadResult::kRequest) co_return read;
    }
    const auto& request = parser.get();
    auto body = parse_body(text(request[field::content_type]), request.body());
    if (!body) {
      exchange.response = problem(body.error().status, body.error().detail, exchange.id);
      co_return ReadResult::kRejected;
    }
    exchange.body = std::move(*body);
    co_return ReadResult::kRequest;
  }

  asio::awaitable<ReadResult> receive_body(Parser& parser, Exchange& exchange) {
    if (parser.content_length().value_or(0) > kMaxRequestBody) {
      reject(exchange, 413, "the body is too large");
      co_return ReadResult::kRejected;
    }
    parser.body_limit(kMaxRequestBody);  // of one that comes in chunks
    const ReadResult expected = co_await meet_expectation(parser.get(), exchange);
    if (expected != ReadResult::kRequest) co_return expected;
    connection_->reads_body = true;
    const auto [error, bytes] =
        co_await beast::http::async_read(connection_->socket, buffer_, parser, kNoThrow);
    connection_->reads_body = false;
    if (error == asio::error::operation_aborted && connection_->socket.is_open()) {
      reject(exchange, 408, "the body did not come in time");
      co_return ReadResult::kRejected;
    }
    co_return error ? rejected(error, exchange) : ReadResult::kRequest;
  }

  // Of a client that asks before it sends a body.
  asio::awaitable<ReadResult> meet_expectation(const RequestHeader& header, Exchange& exchange) {
    if (header.count(field::expect) == 0) co_return ReadResult::kRequest;
    if (!beast::iequals(header[field::expect], "100-continue")) {
      reject(exchange, 417, "the only expectation met is 100-continue");
      co_return ReadResult::kRejected;
    }
    constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    const std::uint64_t sent =
        co_await send_text(*connection_, kContinue, {.patience = server_.pace().patience});
    co_return sent < kContinue.size() ? ReadResult::kClosed : ReadResult::kRequest;
  }

  // Has the answer's sink take the request's body, and make the answer. False where the peer has
  // gone, or the daemon ends: what has come is kept.
  asio::awaitable<bool> pour(Parser& parser, Exchange& exchange) {
    const std::shared_ptr<BodySink> sink = std::move(exchange.response.sink);
    const std::string target(parser.get().target());
    bool goes_on = true;
    if (!parser.is_done()) {
      const ReadResult expected = co_await meet_expectation(parser.get(), exchange);
      if (expected != ReadResult::kRequest) co_return expected == ReadResult::kRejected;
      PieceParser pieces(std::move(parser));
      std::optional<Response> refusal;
      std::vector<std::uint8_t> piece(kPiece);
      while (goes_on && !refusal && !pieces.is_done()) {
        const std::size_t size = co_await read_piece(pieces, piece, goes_on);
        if (size == 0) continue;
        co_await on_worker(Place::kDisk, target,
                           [&] { refusal = sink->take(std::span(piece).first(size)); });
      }
      exchange.has_poured = pieces.is_done();
      give_header_back(pieces, parser);
      if (refusal) exchange.response = std::move(*refusal);
      if (refusal) co_return true;
    }
    co_await on_worker(Place::kDisk, target, [&] { exchange.response = sink->finish(); });
    co_return goes_on;
  }

  // As much of the body as fits into `piece`, or as there is. `goes_on`: more may come.
  asio::awaitable<std::size_t> read_piece(PieceParser& parser, std::span<std::uint8_t> piece,
                                          bool& goes_on) {
    auto& body = parser.get().body();
    body.data = piece.data();
    body.size = piece.size();
    connection_->expires_after(server_.pace().patience);
    const auto [error, bytes] =
        co_await beast::http::async_read(connection_->socket, buffer_, parser, kNoThrow);
    const bool is_well = !error || error == beast::http::error::need_buffer;
    goes_on = parser.is_done() || (is_well && !connection_->draining);
    co_return piece.size() - body.size;
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

  // Sets the route, or the answer where that is known already.
  void find_route(const Parser::value_type& request, Exchange& exchange) {
    const auto target = split_target(text(request.target()));
    if (!target || request.target().size() > kMaxTarget) {
      return reject(exchange, target ? 414 : 400, "the target is not a path");
    }
    const Router& router = server_.router();
    const auto match = router.match(target->path);
    if (!match) {
      exchange.response = problem(404, "there is nothing at this path", exchange.id);
      return;
    }
    exchange.route_template = router.template_of(match->index);
    exchange.parameters = match->parameters;
    const auto method = method_of(request.method());
    const auto route = method ? router.find(*match, *method) : std::nullopt;
    if (route) {
      exchange.route = &router.routes()[*route];
    } else if (request.method() == verb::options) {
      const auto get = router.find(*match, Method::kGet);
      exchange.public_read = get && is_public_read(router.routes()[*get]);
      exchange.response = options(router.allow(*match), exchange.public_read);
    } else if (target->path.starts_with("/api/") && router.is_for_what_is_left(*match)) {
      exchange.response = problem(404, "there is nothing at this path", exchange.id);
    } else {
      exchange.response = not_allowed(router.allow(*match), exchange.id);
    }
  }

  // Sets the answer of the request's route. False where the peer has gone.
  asio::awaitable<bool> answer(Parser& parser, Exchange& exchange) {
    const Parser::value_type& message = parser.get();
    const Route& route = *exchange.route;
    exchange.public_read = is_public_read(route);
    const auto target = split_target(text(message.target()));
    const Request request{message,
                          target->path,
                          target->query,
                          exchange.parameters,
                          exchange.id,
                          exchange.body,
                          exchange.caller,
                          exchange.visitor.encrypted,
                          exchange.visitor.address,
                          route.urgent};
    if (answer_at_once(request, exchange)) co_return true;
    if (route.place != Place::kInline &&
        is_beyond_rate(network_of(exchange.visitor.address), exchange))
      co_return true;
    if (needs_authorisation(route, message)) {
      const bool authorised = co_await authorise_caller(message, exchange);
      if (!authorised || answer_at_once(request, exchange)) co_return true;
    }
    if (takes_json(route)) {
      const ReadResult read = co_await read_body(parser, exchange);
      if (read != ReadResult::kRequest) co_return read == ReadResult::kRejected;
    }
    co_await handle(request, exchange);
    if (!exchange.response.sink) co_return true;
    const bool poured = co_await pour(parser, exchange);
    co_return poured;
  }

  // Sets the answer where it is in memory.
  bool answer_at_once(const Request& request, Exchange& exchange) {
    const Route& route = *exchange.route;
    if (route.quick == nullptr) return false;
    auto quick = route.quick(request, server_.services());
    if (quick) exchange.response = apply_conditions(request.header, std::move(*quick), exchange.id);
    return quick.has_value();
  }

  // Sets the answer to one who asks too often.
  bool is_beyond_rate(std::string_view who, Exchange& exchange) {
    if (exchange.route->urgent) return false;
    const auto wait = server_.rate_limit().take(who);
    if (wait.count() == 0) return false;
    exchange.response = problem(429, "too many requests; wait", exchange.id);
    exchange.response.fields = {{"Retry-After", std::to_string(wait.count())}};
    return true;
  }

  asio::awaitable<bool> authorise_caller(const Parser::value_type& message, Exchange& exchange) {
    const Credentials credentials{message, exchange.visitor.address, exchange.id};
    auto found = authorise_at_once(*exchange.route, credentials, server_.services());
    if (!found) {
      co_await on_worker(Place::kWorker, text(message.target()), [&] {
        found = authorise(*exchange.route, credentials, server_.services());
      });
    }
    exchange.caller = found->caller;
    if (found->refusal) exchange.response = std::move(*found->refusal);
    if (found->refusal || !found->caller) co_return !found->refusal;
    co_return !is_beyond_rate(found->caller->token.to_string(), exchange);
  }

  asio::awaitable<void> handle(const Request& request, Exchange& exchange) {
    const Route& route = *exchange.route;
    const auto run = [&] {
      exchange.response =
          apply_conditions(request.header, guarded(route.handler, request), exchange.id);
    };
    if (route.place == Place::kInline) {
      run();
      co_return;
    }
    const auto seat = server_.workers().reserve(route.place, network_of(exchange.visitor.address));
    if (!seat) {
      exchange.response = no_seat(seat.error(), exchange.id);
      co_return;
    }
    co_await on_worker(route.place, text(request.header.target()), run);
  }

  // Runs `task` there, while this connection waits and others go on.
  template <class Task>
  asio::awaitable<void> on_worker(Place place, std::string_view target, const Task& task) {
    connection_->never_expires();
    auto work = [&]() -> asio::awaitable<void> {
      task();
      co_return;
    };
    co_await asio::co_spawn(server_.workers().executor(place, target), work, asio::use_awaitable);
  }

  // A handler that throws (out of memory, a JSON library's surprise) costs its request alone.
  Response guarded(Handler handler, const Request& request) {
    try {
      return handler(request, server_.services());
    } catch (const std::exception& fault) {
      server_.services().errors.event(
          Severity::kError,
          std::string("request ") + std::string(request.id) + ": " + fault.what());
      const bool no_memory = dynamic_cast<const std::bad_alloc*>(&fault) != nullptr;
      return no_memory ? away(request.id) : problem(500, "", request.id);
    }
  }

  // A stream keeps its connection to one visitor for long, whoever has opened it.
  void check_upgrade(const Parser& parser, Exchange& exchange) {
    if (!parser.is_done()) return reject(exchange, 400, "an upgrade has no body");
    if (server_.connections().count_as(*connection_, exchange.visitor.address)) return;
    exchange.response = problem(429, "this address has too many streams", exchange.id);
    exchange.response.fields = {{"Retry-After", "5"}};
  }

  asio::awaitable<void> stream(Parser::value_type request, Exchange& exchange) {
    const std::string target(request.target());
    connection_->never_expires();
    StreamCall call{.connection = connection_,
                    .request = std::move(request),
                    .model = exchange.parameters.id,
                    .request_id = exchange.id,
                    .address = exchange.visitor.address,
                    .caller = exchange.caller,
                    .head = asks_for_head(target)};
    if (exchange.caller) server_.connections().lasts_for(*connection_, *exchange.caller);
    buffer_ = beast::flat_buffer();
    co_await server_.options().stream(std::move(call));
    record(exchange, "GET", target, 101, 0);
  }

  // False where the peer did not take all of it.
  asio::awaitable<bool> send(const Parser::value_type& request, Exchange& exchange) {
    if (connection_->draining) exchange.keep_alive = false;
    const bool with_body = request.method() != verb::head;
    const auto room = with_body ? server_.bodies().admit(exchange.response.body) : nullptr;
    if (with_body && !room)
      exchange.response = no_room(server_.bodies().fits_alone(exchange.response.body), exchange.id);
    Response& response = exchange.response;
    if (response.events) exchange.keep_alive = false;  // their end is the connection's
    const bool public_read = exchange.public_read && response.caching != Caching::kPrivate;
    const HeadOptions options{exchange.id, exchange.keep_alive, public_read, request.version(),
                              connection_->socket.is_encrypted()};
    std::string head = response_head(response, options);
    const unsigned status = response.status;
    Body body = with_body ? std::move(response.body) : Body();
    const std::uint64_t size = body_size(body);
    std::uint64_t sent =
        co_await send_response(*connection_, std::move(head), std::move(body), server_.pace());
    const bool lasts = response.events && with_body;
    if (lasts && exchange.caller) server_.connections().lasts_for(*connection_, *exchange.caller);
    if (lasts) sent = co_await send_events(*connection_, *response.events, server_.pace().patience);
    record(exchange, text(request.method_string()), text(request.target()), status, sent);
    const bool last = !exchange.keep_alive || connection_->draining;
    lingers_ = sent >= size && last;
    co_return sent >= size;
  }

  void record(const Exchange& exchange, std::string_view method, std::string_view target,
              unsigned status, std::uint64_t bytes) {
    const auto& templates = server_.router().templates();
    const std::string_view route =
        exchange.route_template < templates.size() ? templates[exchange.route_template] : "-";
    if (exchange.route != nullptr && changes(exchange.route->method))
      audit(exchange, route, method, target, status);
    if (!server_.options().recorded) return;
    const std::chrono::duration<double> seconds = Connection::Clock::now() - exchange.start;
    server_.services().metrics.request(exchange.route_template, status, bytes, seconds.count());
    const Log& log = server_.services().log;
    const bool waits = log.access({.request_id = exchange.id,
                                   .remote = exchange.visitor.address,
                                   .method = method,
                                   .route = route,
                                   .target = target,
                                   .status = status,
                                   .bytes = bytes,
                                   .seconds = seconds.count()});
    // Once those are served whose turn it is now.
    if (waits) asio::post(server_.io(), [&log] { log.flush(); });
  }

  // In the operator's log, which nothing switches off.
  void audit(const Exchange& exchange, std::string_view route, std::string_view method,
             std::string_view target, unsigned status) {
    const std::string token = exchange.caller ? exchange.caller->token.to_string() : "-";
    server_.services().errors.audit({.request_id = exchange.id,
                                     .remote = exchange.visitor.address,
                                     .token = token,
                                     .method = method,
                                     .route = route,
                                     .target = target,
                                     .status = status});
  }

  // Closing while the peer still sends would reset the connection, and the peer might lose our
  // answer: what it sends is read and dropped for a moment.
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
  if (const auto& tls = server.options().tls) {
    connection->expires_after(server.pace().patience);
    const auto error = co_await connection->socket.encrypt(tls->current());
    if (error) co_return;
  }
  Session session(connection, server);
  co_await session.run();
}

}  // namespace vitrine
