// SPDX-License-Identifier: Apache-2.0
#include "server/http/dispatcher.h"

#include "server/http/authorise.h"
#include "server/messages/body_sink.h"
#include "server/messages/conditional.h"
#include "server/messages/query.h"

namespace vitrine::server {
namespace {

using beast::http::verb;

constexpr std::size_t kMaxTarget = 8 * 1024;

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
    case verb::options:
      return Method::kOptions;
    default:
      return std::nullopt;
  }
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

Response not_allowed(std::string allow, std::string_view id) {
  Response response = problem(405, "the path does not take this method", id);
  response.fields = {{"Allow", std::move(allow)}};
  return response;
}

Response not_admitted(AdmissionLimit::Refusal why, std::string_view id) {
  // A running task ends within seconds, so the client may retry soon.
  if (why == AdmissionLimit::Refusal::kFull) return away(id);
  Response response = problem(429, "this address has enough under way; wait", id);
  response.fields = {{"Retry-After", "5"}};
  return response;
}

bool takes_json(const Route& route) {
  return route.reads_body && (route.method == Method::kPost || route.method == Method::kPatch);
}

// Sets the response and returns true if the route can answer from memory.
bool answer_at_once(const Request& request, Exchange& exchange) {
  if (!exchange.route->quick) return false;
  auto quick = exchange.route->quick(request);
  if (quick) exchange.response = apply_conditions(request.header, std::move(*quick), exchange.id);
  return quick.has_value();
}

}  // namespace

asio::awaitable<bool> Dispatcher::dispatch(RequestParser& parser, Exchange& exchange) {
  find_route(parser.get(), exchange);
  if (exchange.route == nullptr) co_return true;
  co_return co_await answer(parser, exchange);
}

// Sets the route, or the response if no handler is needed to make it.
void Dispatcher::find_route(const RequestParser::value_type& request, Exchange& exchange) const {
  const auto target = split_target(target_of(request));
  if (!target || request.target().size() > kMaxTarget) {
    return exchange.reject(target ? 414 : 400, "the target is not a path");
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
                        .caller = exchange.caller,
                        .is_encrypted = exchange.client.is_encrypted,
                        .client_address = exchange.client.address,
                        .is_urgent = route.is_urgent};
  if (answer_at_once(request, exchange)) co_return true;
  if (route.executor != Executor::kInline &&
      is_beyond_rate(network_of(exchange.client.address), exchange)) {
    co_return true;
  }
  if (needs_authorisation(route, header)) {
    const bool is_authorised = co_await authorise_caller(header, exchange);
    if (!is_authorised || answer_at_once(request, exchange)) co_return true;
  }
  if (takes_json(route)) {
    const ReadResult read = co_await reader_.read_json(parser, exchange);
    if (read != ReadResult::kRead) co_return read == ReadResult::kRejected;
  }
  co_await handle(request, exchange);
  if (!exchange.response.sink) co_return true;
  co_return co_await pour(parser, exchange);
}

// Sets a 429 response and returns true if `client` exceeds the request rate.
bool Dispatcher::is_beyond_rate(std::string_view client, Exchange& exchange) {
  if (exchange.route->is_urgent) return false;
  const auto wait = server_.rate_limit().take(client);
  if (wait.count() == 0) return false;
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
    co_await on_worker(Executor::kWorker, target_of(header),
                       [&] { found = authorise(*exchange.route, credentials, with); });
  }
  exchange.caller = found->caller;
  if (found->refusal) exchange.response = std::move(*found->refusal);
  if (found->refusal || !found->caller) co_return !found->refusal;
  co_return !is_beyond_rate(found->caller->token.to_string(), exchange);
}

asio::awaitable<void> Dispatcher::handle(const Request& request, Exchange& exchange) {
  const Route& route = *exchange.route;
  const auto run = [&] {
    exchange.response =
        apply_conditions(request.header, guarded(route.handler, request), exchange.id);
  };
  if (route.executor == Executor::kInline) {
    run();
    co_return;
  }
  const auto pass = server_.workers().admit(route.executor, network_of(exchange.client.address));
  if (!pass) {
    exchange.response = not_admitted(pass.error(), exchange.id);
    co_return;
  }
  co_await on_worker(route.executor, target_of(request.header), run);
}

// Calls the handler and catches its exceptions (out of memory, an unexpected library error), so
// that only this request fails.
Response Dispatcher::guarded(const Handler& handler, const Request& request) {
  try {
    return handler(request);
  } catch (const std::exception& fault) {
    server_.dependencies().events.event(
        Severity::kError, std::string("request ") + std::string(request.id) + ": " + fault.what());
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&fault) != nullptr;
    return no_memory ? away(request.id) : problem(500, "", request.id);
  }
}

// Passes the request's body to the response's sink, which then makes the final response. The sink
// keeps what it has received, even if the peer disconnects or the server drains.
asio::awaitable<bool> Dispatcher::pour(RequestParser& parser, Exchange& exchange) {
  const std::shared_ptr<BodySink> sink = std::move(exchange.response.sink);
  const std::string target(target_of(parser.get()));
  std::optional<Response> refusal;
  RequestReader::Consumer take = [&](std::span<const std::uint8_t> piece) -> asio::awaitable<bool> {
    co_await on_worker(Executor::kDisk, target, [&] { refusal = sink->take(piece); });
    co_return !refusal;
  };
  const ReadResult read = co_await reader_.read_pieces(parser, exchange, std::move(take));
  if (refusal) exchange.response = std::move(*refusal);
  if (refusal || read == ReadResult::kRejected) co_return true;
  co_await on_worker(Executor::kDisk, target, [&] { exchange.response = sink->finish(); });
  co_return read == ReadResult::kRead;
}

// Runs `task` on a worker. This connection waits meanwhile; others are served.
template <class Task>
asio::awaitable<void> Dispatcher::on_worker(Executor executor, std::string_view target,
                                            const Task& task) {
  connection_.never_expires();
  auto work = [&]() -> asio::awaitable<void> {
    task();
    co_return;
  };
  co_await asio::co_spawn(server_.workers().executor(executor, target), work, asio::use_awaitable);
}

}  // namespace vitrine::server
