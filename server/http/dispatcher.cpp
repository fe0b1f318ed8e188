// SPDX-License-Identifier: Apache-2.0
#include "server/http/dispatcher.h"

#include "server/http/authorise.h"
#include "server/messages/body_sink.h"
#include "server/messages/conditional.h"
#include "server/messages/content_coding.h"
#include "server/messages/query.h"
#include "server/messages/request_body.h"

namespace vitrine::server {
namespace {

using beast::http::verb;

constexpr std::size_t kMaxTarget = 8 * 1024;
// Size in bytes of the largest JSON that is compressed on a thread that serves connections.
// Compression of this size takes about a millisecond.
constexpr std::size_t kMostCompressedInline = 64 * 1024;
// Size in bytes of the largest JSON that a worker compresses.
constexpr std::size_t kMostCompressed = 4 * 1024 * 1024;

std::string_view target_of(const RequestHeader& header) {
  return {header.target().data(), header.target().size()};
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
    case verb::put:
      return Method::kPut;
    case verb::options:
      return Method::kOptions;
    default:
      return std::nullopt;
  }
}

// Returns the method that the request asks for. Clients that can send only GET and POST send POST
// with the real method in X-HTTP-Method-Override (tus 1.0.0).
verb method_sent(const RequestHeader& header) {
  if (header.method() != verb::post) return header.method();
  const verb real = beast::http::string_to_verb(header["X-HTTP-Method-Override"]);
  const bool is_taken = real == verb::patch || real == verb::put || real == verb::delete_;
  return is_taken ? real : verb::post;
}

// Whether the listener answers requests for the host that the request names (protection from DNS
// rebinding).
bool is_answered_host(const RequestHeader& header, const HttpOptions& options) {
  const auto host = header[beast::http::field::host];
  return !options.answers_to || options.answers_to({host.data(), host.size()});
}

// Answers an OPTIONS request, which may be a CORS preflight. Pages of other origins may only read
// public paths.
Response options(std::string allow, bool is_public_read) {
  Response response;
  response.status = 204;
  response.fields = {{"Allow", std::move(allow)}};
  if (is_public_read) {
    response.fields.insert(response.fields.end(),
                           {{"Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"},
                            {"Access-Control-Allow-Headers", "If-None-Match, If-Range, Range"},
                            {"Access-Control-Max-Age", "86400"}});
  }
  return response;
}

// Returns the origin of the request (the web page that sent it) if pages of this origin may send
// any request. Otherwise returns an empty string.
std::string trusted_origin_of(const RequestHeader& header, const HttpOptions& options) {
  const auto sent = header[beast::http::field::origin];
  const bool is_trusted =
      !sent.empty() && options.trusts_origin && options.trusts_origin({sent.data(), sent.size()});
  return is_trusted ? std::string(sent) : std::string();
}

// Allows the fields and methods that a preflight requests, for pages of a trusted origin.
void allow_all(const RequestHeader& header, Response& response) {
  const auto wanted = header[beast::http::field::access_control_request_headers];
  std::erase_if(response.fields,
                [](const auto& field) { return field.first.starts_with("Access"); });
  response.fields.insert(
      response.fields.end(),
      {{"Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, PATCH, DELETE, OPTIONS"},
       {"Access-Control-Allow-Headers", std::string(wanted)},
       {"Access-Control-Max-Age", "600"}});
}

Response not_allowed(std::string allow, std::string_view id) {
  Response response = problem(405, "the path does not take this method", id);
  response.fields = {{"Allow", std::move(allow)}};
  return response;
}

Response not_admitted(AdmissionLimit::Refusal why, std::string_view id) {
  // A running task ends within seconds, so the client may retry soon.
  if (why == AdmissionLimit::Refusal::kFull) return away(id);
  Response response =
      problem(429, "this address has too many requests in progress; wait for one to end", id);
  response.fields = {{"Retry-After", "5"}};
  return response;
}

// Returns the owner of the request for fair queueing: its token, or its network if it has no token.
std::string owner_of(const Exchange& exchange) {
  return exchange.caller ? exchange.caller->token.to_string() : network_of(exchange.client.address);
}

// Returns the owner under which the lookup of the request's token waits for its turn: the client's
// network. Emergency stops get another owner, so that they do not wait for other lookups of the
// same network.
std::string lookup_owner_of(const Exchange& exchange) {
  return (is_urgent(*exchange.route) ? "stop " : "") + network_of(exchange.client.address);
}

bool takes_body(const Route& route, BodyKind kind) {
  const bool sends = route.method == Method::kPost || route.method == Method::kPatch ||
                     route.method == Method::kPut;
  return route.body == kind && sends;
}

// If the route can answer from memory, sets the response and returns true.
bool answer_at_once(const Request& request, Exchange& exchange) {
  if (!exchange.route->quick) return false;
  auto quick = exchange.route->quick(request);
  if (quick) exchange.response = apply_conditions(request.header, std::move(*quick), exchange.id);
  return quick.has_value();
}

}  // namespace

asio::awaitable<bool> Dispatcher::dispatch(RequestParser& parser, Exchange& exchange) {
  exchange.trusted_origin = trusted_origin_of(parser.get(), server_.options());
  find_route(parser.get(), exchange);
  const bool is_answered = exchange.route == nullptr || co_await answer(parser, exchange);
  const bool is_preflight =
      parser.get().method() == verb::options && exchange.response.status == 204;
  if (is_preflight && !exchange.trusted_origin.empty()) {
    exchange.is_public_read = false;
    allow_all(parser.get(), exchange.response);
  }
  if (is_answered) count_error(exchange);
  co_return is_answered;
}

void Dispatcher::count_error(Exchange& exchange) {
  const bool is_stop = exchange.route != nullptr && is_urgent(*exchange.route) && exchange.caller;
  const bool is_made = exchange.route != nullptr && exchange.response.status < 400;
  if (is_made || exchange.is_rated || is_stop) return;
  static_cast<void>(has_no_call_left(network_of(exchange.client.address), exchange));
}

// Sets the route. If no handler is needed, sets the response instead.
void Dispatcher::find_route(const RequestParser::value_type& request, Exchange& exchange) const {
  const auto target = split_target(target_of(request));
  if (!target || request.target().size() > kMaxTarget) {
    return exchange.reject(target ? 414 : 400, "the target is not a path");
  }
  if (!is_answered_host(request, server_.options())) {
    exchange.is_public_read = false;
    exchange.response = problem(
        421, "the server does not answer to this host name; its setting 'hosts' lists the names",
        exchange.id);
    return;
  }
  const Router& router = server_.router();
  const auto match = router.match(target->path);
  if (!match) {
    exchange.response = problem(404, "there is nothing at this path", exchange.id);
    return;
  }
  exchange.route_template = router.template_of(match->index);
  exchange.parameters = match->parameters;
  const auto method = method_of(method_sent(request));
  const auto route = method ? router.find(*match, *method) : std::nullopt;
  if (route) {
    exchange.route = &router.routes()[*route];
  } else if (request.method() == verb::options) {
    const auto get = router.find(*match, Method::kGet);
    exchange.is_public_read = get && is_public_read(router.routes()[*get]);
    exchange.response = options(router.allow(*match), exchange.is_public_read);
  } else if (target->path.starts_with("/api/") && router.is_catch_all(*match)) {
    exchange.response = problem(404, "there is nothing at this path", exchange.id);
  } else {
    exchange.response = not_allowed(router.allow(*match), exchange.id);
  }
}

asio::awaitable<bool> Dispatcher::answer(RequestParser& parser, Exchange& exchange) {
  const RequestHeader& header = parser.get();
  const Route& route = *exchange.route;
  exchange.is_public_read = is_public_read(route);
  const auto target = split_target(target_of(header));
  const Request request{.header = header,
                        .path = target->path,
                        .query = target->query,
                        .parameters = exchange.parameters,
                        .id = exchange.id,
                        .body = exchange.body,
                        .form = exchange.form,
                        .caller = exchange.caller,
                        .is_encrypted = exchange.client.is_encrypted,
                        .client_address = exchange.client.address,
                        .is_urgent = is_urgent(route)};
  if (answer_at_once(request, exchange)) co_return true;
  if (route.executor != Executor::kInline &&
      is_beyond_rate(network_of(exchange.client.address), exchange)) {
    co_return true;
  }
  if (needs_authorisation(route, header)) {
    const bool is_authorised = co_await authorise_caller(header, exchange);
    if (!is_authorised || answer_at_once(request, exchange)) co_return true;
  }
  const bool is_large = takes_body(route, BodyKind::kLargeJson);
  if (is_large || takes_body(route, BodyKind::kJson)) {
    const std::size_t most = is_large ? kMaxLargeRequestBody : kMaxRequestBody;
    const ReadResult read = co_await reader_.read_json(parser, exchange, most);
    if (read != ReadResult::kRead) co_return read == ReadResult::kRejected;
  }
  if (takes_body(route, BodyKind::kForm)) {
    const ReadResult read = co_await reader_.read_form(parser, exchange);
    if (read != ReadResult::kRead) co_return read == ReadResult::kRejected;
  }
  co_await handle(request, exchange);
  if (!exchange.response.sink) co_return true;
  co_return co_await pour(parser, exchange);
}

// Sets a 429 response and returns true if `client` exceeds the request rate.
bool Dispatcher::is_beyond_rate(std::string_view client, Exchange& exchange) {
  return !is_urgent(*exchange.route) && has_no_call_left(client, exchange);
}

bool Dispatcher::has_no_call_left(std::string_view client, Exchange& exchange) {
  exchange.is_rated = true;
  const auto wait = server_.rate_limit().take(client);
  if (wait.count() == 0) return false;
  exchange.is_beyond_rate = true;
  exchange.response = problem(429, "too many requests; wait", exchange.id);
  exchange.response.fields = {{"Retry-After", std::to_string(wait.count())}};
  return true;
}

asio::awaitable<bool> Dispatcher::authorise_caller(const RequestHeader& header,
                                                   Exchange& exchange) {
  const HttpDependencies& with = server_.dependencies();
  const Credentials credentials{header, exchange.client.address, exchange.id};
  auto found = authorise_at_once(*exchange.route, credentials, with);
  if (!found) {
    connection_.never_expires();
    co_await server_.workers().look_up_token(
        lookup_owner_of(exchange), [&] { found = authorise(*exchange.route, credentials, with); });
  }
  exchange.caller = found->caller;
  if (found->refusal) exchange.response = std::move(*found->refusal);
  if (found->refusal || !found->caller) co_return !found->refusal;
  co_return !is_beyond_rate(found->caller->token.to_string(), exchange);
}

asio::awaitable<void> Dispatcher::handle(const Request& request, Exchange& exchange) {
  const Route& route = *exchange.route;
  const auto call = [&] {
    const bool is_inline = route.executor == Executor::kInline;
    return in_accepted_coding(request.header, route.handler(request),
                              is_inline ? kMostCompressedInline : kMostCompressed);
  };
  const auto run = [&] {
    exchange.response = apply_conditions(request.header, guarded(request.id, call), exchange.id);
  };
  if (route.executor == Executor::kInline) {
    run();
    co_return;
  }
  if (route.opens && co_await open_first(request, exchange, run)) co_return;
  const auto pass = server_.workers().admit(route.executor, network_of(exchange.client.address));
  if (!pass) {
    exchange.response = not_admitted(pass.error(), exchange.id);
    co_return;
  }
  co_await on_worker(route.executor, exchange, run, std::string(target_of(request.header)));
}

// Opens the file that the handler needs, on threads that only open files. If handlers opened large
// files themselves, they would occupy the handlers' threads and delay requests for other files. If
// the handler needs no such file and runs on a worker, calls `run` and returns true. Otherwise
// returns false; the caller must then run the handler.
asio::awaitable<bool> Dispatcher::open_first(const Request& request, const Exchange& exchange,
                                             const std::function<void()>& run) {
  const Route& route = *exchange.route;
  std::optional<Opening> opening;
  bool has_run = false;
  co_await on_worker(Executor::kWorker, exchange, [&] {
    try {
      opening = route.opens(request);
    } catch (const std::exception&) {  // the handler opens the file itself, and reports the fault
    }
    has_run = !opening && route.executor == Executor::kWorker;
    if (has_run) run();
  });
  if (opening) co_await server_.workers().open(owner_of(exchange), std::move(*opening));
  co_return has_run;
}

// Calls `make` and catches its exceptions, such as std::bad_alloc, so that only this request fails.
// Returns the result, or the response of a failure.
template <class Make>
auto Dispatcher::guarded(std::string_view id, const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const std::exception& fault) {
    server_.dependencies().events.event(
        Severity::kError, std::string("request ") + std::string(id) + ": " + fault.what());
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&fault) != nullptr;
    return no_memory ? away(id) : problem(500, "", id);
  }
}

// Passes the request's body to the response's sink, which then makes the final response. The sink
// keeps what it has received, even if the peer disconnects or the server drains.
asio::awaitable<bool> Dispatcher::pour(RequestParser& parser, Exchange& exchange) {
  const std::shared_ptr<BodySink> sink = std::move(exchange.response.sink);
  std::optional<Response> refusal;
  RequestReader::Consumer take = [&](std::span<const std::uint8_t> piece) -> asio::awaitable<bool> {
    co_await on_worker(Executor::kDisk, exchange,
                       [&] { refusal = guarded(exchange.id, [&] { return sink->take(piece); }); });
    co_return !refusal;
  };
  const ReadResult read = co_await reader_.read_pieces(parser, exchange, std::move(take));
  if (refusal) exchange.response = std::move(*refusal);
  if (refusal || read == ReadResult::kRejected) co_return true;
  co_await on_worker(Executor::kDisk, exchange, [&] {
    exchange.response = guarded(exchange.id, [&] { return sink->finish(); });
  });
  co_return read == ReadResult::kRead;
}

// Runs `task` on a worker. This connection waits; other connections are served in the meantime.
template <class Task>
asio::awaitable<void> Dispatcher::on_worker(Executor executor, const Exchange& exchange,
                                            const Task& task, std::string target) {
  connection_.never_expires();
  co_await server_.workers().run(executor, owner_of(exchange), std::move(target), task);
}

}  // namespace vitrine::server
