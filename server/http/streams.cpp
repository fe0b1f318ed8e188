// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/http/handlers.h"
#include "server/http/origin.h"
#include "server/http/published.h"
#include "server/http/query.h"

namespace vitrine {
namespace {

using beast::http::field;

Response upgrade_required(std::string_view request_id) {
  Response response = problem(426, "connect with WebSocket, subprotocol pmesh.v1", request_id);
  response.fields = {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}};
  return response;
}

// ?head=true: whether the head comes first; nothing where the query is another.
std::optional<bool> head_in(std::string_view text) {
  constexpr std::string_view kKnown[] = {"head"};
  const auto query = Query::parse(text);
  if (!query || query->unknown(kKnown)) return std::nullopt;
  const std::string_view head = query->get("head").value_or("false");
  if (head != "true" && head != "false") return std::nullopt;
  return head == "true";
}

bool offers_protocol(const RequestHeader& header) {
  return beast::http::token_list(header[field::sec_websocket_protocol]).exists("pmesh.v1");
}

}  // namespace

Response open_stream(const Request& request, Services& services) {
  if (!beast::websocket::is_upgrade(request.header)) return upgrade_required(request.id);
  if (!offers_protocol(request.header)) {
    return problem(400, "offer the subprotocol pmesh.v1", request.id);
  }
  if (!head_in(request.query)) return problem(400, "head is true or false", request.id);
  if (!is_allowed_origin(request.header, services.settings.get()->allowed_origins)) {
    return problem(403, "pages of this origin may not open streams here", request.id);
  }
  return with_model(request, services, [](const auto&) { return Response{.status = 101}; });
}

bool asks_for_head(std::string_view target) {
  return head_in(split_target(target)->query).value_or(false);
}

}  // namespace vitrine
