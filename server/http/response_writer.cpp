// SPDX-License-Identifier: Apache-2.0
#include "server/http/response_writer.h"

#include "server/http/event_stream.h"

namespace vitrine::server {
namespace {

std::string_view text(beast::string_view view) {
  return {view.data(), view.size()};
}

Response no_room(bool will_be, std::string_view id) {
  if (will_be) return away(id);
  return problem(507, "the answer is larger than answer-memory allows; ask for a coarser level",
                 id);
}

bool changes_data(Method method) {
  return method != Method::kGet && method != Method::kOptions;
}

}  // namespace

asio::awaitable<bool> ResponseWriter::write(const RequestHeader& request, Exchange& exchange) {
  if (connection_.draining) exchange.keep_alive = false;
  const bool has_body = request.method() != beast::http::verb::head;
  const auto room = has_body ? server_.bodies().admit(exchange.response.body) : nullptr;
  if (has_body && !room)
    exchange.response = no_room(server_.bodies().fits_alone(exchange.response.body), exchange.id);
  Response& response = exchange.response;
  if (response.events) exchange.keep_alive = false;  // the connection closes after the last event
  std::string head = response_head(
      response, {.request_id = exchange.id,
                 .keep_alive = exchange.keep_alive,
                 .is_public_read = exchange.is_public_read && response.caching != Caching::kPrivate,
                 .version = request.version(),
                 .is_encrypted = connection_.socket.is_encrypted()});
  const unsigned status = response.status;
  Body body = has_body ? std::move(response.body) : Body();
  const std::uint64_t size = body_size(body);
  std::uint64_t sent =
      co_await send_response(connection_, std::move(head), std::move(body), server_.pace());
  const bool lasts = response.events && has_body;
  if (lasts && exchange.caller) server_.connections().lasts_for(connection_, *exchange.caller);
  if (lasts) sent = co_await send_events(connection_, *response.events, server_.pace().timeout);
  record(exchange, request, status, sent);
  is_at_end_ = sent >= size && (!exchange.keep_alive || connection_.draining);
  co_return sent >= size;
}

void ResponseWriter::record(const Exchange& exchange, const RequestHeader& request, unsigned status,
                            std::uint64_t bytes) const {
  const auto& templates = server_.router().templates();
  const std::string_view route =
      exchange.route_template < templates.size() ? templates[exchange.route_template] : "-";
  if (exchange.route != nullptr && changes_data(exchange.route->method))
    audit(exchange, request, route, status);
  if (!server_.options().is_recorded) return;
  const std::chrono::duration<double> seconds = Connection::Clock::now() - exchange.start;
  const HttpDependencies& with = server_.dependencies();
  with.metrics.request(exchange.route_template, status, bytes, seconds.count());
  const bool waits = with.access_log.access({.request_id = exchange.id,
                                             .remote = exchange.client.address,
                                             .method = text(request.method_string()),
                                             .route = route,
                                             .target = text(request.target()),
                                             .status = status,
                                             .bytes = bytes,
                                             .seconds = seconds.count()});
  // The flush is posted, so that pending requests are served first.
  if (waits) asio::post(server_.io(), [&log = with.access_log] { log.flush(); });
}

// Writes the request to the audit log, which no setting disables.
void ResponseWriter::audit(const Exchange& exchange, const RequestHeader& request,
                           std::string_view route, unsigned status) const {
  const std::string token = exchange.caller ? exchange.caller->token.to_string() : "-";
  server_.dependencies().events.audit({.request_id = exchange.id,
                                       .remote = exchange.client.address,
                                       .token = token,
                                       .method = text(request.method_string()),
                                       .route = route,
                                       .target = text(request.target()),
                                       .status = status});
}

}  // namespace vitrine::server
