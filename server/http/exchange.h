// SPDX-License-Identifier: Apache-2.0
// One request and its response. The reader, the dispatcher and the writer of a session fill in the
// members.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/http/connection.h"
#include "server/http/request_id.h"
#include "server/messages/client.h"
#include "server/messages/problem.h"
#include "server/messages/response.h"
#include "server/messages/router.h"

namespace vitrine::server {

struct Exchange {
  std::string id = next_request_id();
  Connection::Clock::time_point start = Connection::Clock::now();
  Client client;
  // Index of the route's path in Router::templates(), or SIZE_MAX if no route matches.
  std::size_t route_template = SIZE_MAX;
  PathParameters parameters;
  // The route whose handler makes the response. Null before Dispatcher::find_route() sets it, and
  // if the response needs no handler.
  const Route* route = nullptr;
  std::optional<Caller> caller;
  nlohmann::json body = nlohmann::json::object();
  std::string form;             // see Request::form
  bool is_rated = false;        // whether the request has been counted towards a request rate
  bool is_beyond_rate = false;  // whether the response is 429 because of a request rate
  bool is_body_read = false;
  bool is_public_read = true;
  std::string trusted_origin;  // the page's origin if it may read every response; else empty
  bool keeps_alive = true;
  Response response;

  // Sets an error response. The connection closes after it, because the start of the next request
  // is unknown.
  void reject(unsigned status, std::string_view detail) {
    response = problem(status, detail, id);
    keeps_alive = false;
  }
};

}  // namespace vitrine::server
