// SPDX-License-Identifier: Apache-2.0
#include "server/messages/problem.h"

#include <nlohmann/json.hpp>

#include "server/messages/http_header.h"

namespace vitrine::server {

Response problem(unsigned status, std::string_view detail, std::string_view request_id,
                 const std::vector<ParameterFault>& errors) {
  const auto title = beast::http::obsolete_reason(static_cast<beast::http::status>(status));
  nlohmann::ordered_json json = {{"type", "about:blank"},
                                 {"title", std::string(title)},
                                 {"status", status},
                                 {"request_id", request_id}};
  const bool is_told = status < 500 || status == 507;
  if (is_told && !detail.empty()) json["detail"] = detail;
  for (const ParameterFault& error : errors) {
    json["errors"].push_back({{"parameter", error.parameter}, {"detail", error.detail}});
  }
  Response response;
  response.status = status;
  response.type = kProblemType;
  // Replaces invalid UTF-8, because the text may come from a client.
  response.body = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return response;
}

Response away(std::string_view request_id) {
  Response response = problem(503, "", request_id);
  response.fields = {{"Retry-After", "5"}};
  return response;
}

}  // namespace vitrine::server
