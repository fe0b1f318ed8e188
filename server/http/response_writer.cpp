// SPDX-License-Identifier: Apache-2.0
#include "server/http/response_writer.h"

#include "server/config/networks.h"
#include "server/http/event_stream.h"
#include "server/messages/problem_page.h"

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

// Whether the request tried to change data.
bool is_change(const Exchange& exchange) {
  return exchange.route != nullptr && exchange.route->method != Method::kGet &&
         exchange.route->method != Method::kOptions;
}

// Whether the request tried to change data that only callers with a role may change. Reports of
// visits are excluded: everybody may send them, and the audit log must not record who did.
bool is_audited(const Exchange& exchange) {
  return is_change(exchange) && exchange.route->role != Role::kNone;
}

// Whether the logs may omit this request if its address sends many such requests. True if the
// request exceeded a rate limit, or tried to change data and was refused: any client can send
// unlimited numbers of such requests.
bool is_rationed(const Exchange& exchange, unsigned status) {
  const bool is_refused = status >= 400 && status < kUnanswered;
  return exchange.is_beyond_rate || (is_refused && is_change(exchange));
}

// Whether the response came from memory. No rate limit has counted such a request.
bool is_from_memory(const Exchange& exchange) {
  return !exchange.is_rated && !is_change(exchange);
}

}  // namespace

asio::awaitable<bool> ResponseWriter::write(const RequestHeader& request, Exchange& exchange) {
  if (connection_.is_draining) exchange.keeps_alive = false;
  const bool has_body = request.method() != beast::http::verb::head;
  const auto room =
      has_body ? server_.bodies().admit(exchange.response.body, network_of(exchange.client.address))
               : nullptr;
  if (has_body && !room)
    exchange.response = no_room(server_.bodies().fits_alone(exchange.response.body), exchange.id);
  Response& response = exchange.response;
  if (response.type == kProblemType && wants_page(request))
    response = problem_page(std::move(response), request);
  if (response.events) exchange.keeps_alive = false;  // the connection closes after the last event
  std::string head = response_head(
      response, {.request_id = exchange.id,
                 .keeps_alive = exchange.keeps_alive,
                 .is_public_read = server_.options().is_read_by_pages && exchange.is_public_read &&
                                   response.caching != Caching::kPrivate,
                 .trusted_origin = exchange.trusted_origin,
                 .version = request.version(),
                 .is_encrypted = connection_.socket.is_encrypted()});
  const unsigned status = response.status;
  Body body = has_body ? std::move(response.body) : Body();
  const std::uint64_t size = body_size(body);
  const Pace pace = server_.pace_of(body);
  std::uint64_t sent = co_await send_response(connection_, std::move(head), std::move(body), pace);
  const bool lasts = response.events && has_body;
  if (lasts) {
    server_.lasts_while(connection_, exchange.caller,
                        [events = response.events] { return events->may_continue(); });
    sent = co_await send_events(connection_, *response.events, server_.pace().timeout);
  }
  record(exchange, request, status, sent);
  is_at_end_ = sent >= size && (!exchange.keeps_alive || connection_.is_draining);
  co_return sent >= size;
}

void ResponseWriter::record(const Exchange& exchange, const RequestHeader& request, unsigned status,
                            std::uint64_t bytes) const {
  const auto& templates = server_.router().templates();
  const std::string_view route =
      exchange.route_template < templates.size() ? templates[exchange.route_template] : "-";
  const bool has_line =
      !is_rationed(exchange, status) || server_.may_log_refusal(exchange.client.address);
  if (has_line && is_audited(exchange)) audit(exchange, request, route, status);
  if (!server_.options().is_recorded) return;
  const std::chrono::duration<double> seconds = Connection::Clock::now() - exchange.start;
  const HttpDependencies& with = server_.dependencies();
  with.metrics.request(exchange.route_template, status, bytes, seconds.count());
  if (!has_line && exchange.is_beyond_rate) return;
  if (is_from_memory(exchange) && !server_.may_log_answer(exchange.client.address)) return;
  const bool waits = with.access_log.access({.request_id = exchange.id,
                                             .remote = logged_address(exchange.client),
                                             .method = text(request.method_string()),
                                             .route = route,
                                             .target = text(request.target()),
                                             .status = status,
                                             .bytes = bytes,
                                             .seconds = seconds.count()});
  // Posts the flush to the event loop, so that pending requests are served first.
  if (waits) asio::post(server_.io(), [&log = with.access_log] { log.flush(); });
}

std::string ResponseWriter::logged_address(const Client& client) const {
  return server_.options().shortens_addresses ? shortened(client.address) : client.address;
}

// Writes the request to the audit log, which no setting disables.
void ResponseWriter::audit(const Exchange& exchange, const RequestHeader& request,
                           std::string_view route, unsigned status) const {
  const std::string token = exchange.caller ? exchange.caller->token.to_string() : "-";
  server_.dependencies().events.audit({.request_id = exchange.id,
                                       .remote = logged_address(exchange.client),
                                       .token = token,
                                       .method = text(request.method_string()),
                                       .route = route,
                                       .target = text(request.target()),
                                       .status = status});
}

}  // namespace vitrine::server
