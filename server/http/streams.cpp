// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/http/handlers.h"
#include "server/http/published.h"

namespace vitrine {
namespace {

using beast::http::field;

Response upgrade_required(std::string_view request_id) {
  Response response = problem(426, "connect with WebSocket, subprotocol pmesh.v1", request_id);
  response.fields = {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}};
  return response;
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
  return with_published(request, services, [](const auto&) { return Response{.status = 101}; });
}

}  // namespace vitrine
