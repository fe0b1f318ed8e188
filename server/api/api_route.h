// SPDX-License-Identifier: Apache-2.0
// Declares ApiRoute, a REST route with its documentation. bind() converts ApiRoutes to routes of
// the HTTP server.
#pragma once

#include <span>
#include <vector>

#include "server/messages/router.h"

namespace vitrine::server {

struct Services;

using ApiHandler = Response (*)(const Request& request, Services& services);
using ApiOpeningFinder = std::optional<Opening> (*)(const Request& request, Services& services);
using ApiQuickHandler = std::optional<Response> (*)(const Request& request, Services& services);

// Documentation of a route for the OpenAPI document. It refers to schemas and parameters by the
// names that they have in ApiNoun::components.
struct RouteDoc {
  std::string_view id = {};          // unique operationId; empty if the route is not documented
  std::string_view summary = {};     // one or two sentences
  std::string_view parameters = {};  // names of query and header parameters, separated by spaces
  // schema or media type of the request body; empty if there is no body
  std::string_view request = {};
  bool is_request_optional = false;  // whether the request may have no body
  unsigned status = 200;             // HTTP status on success
  // schema or media type of the response body; empty if there is no body
  std::string_view response = {};
  // media type of a response whose body is described by a schema
  std::string_view response_type = "application/json";
  // whether a client without a token may receive the response compressed by gzip
  bool may_be_gzip = false;
};

// A route of the API. `doc` documents it in the OpenAPI document. The other members mean the same
// as in Route. If `opens` is null and the executor is kWorker or kCompute, bind() derives
// Route::opens from the path. The server then opens the file of the model that the path names, or
// of the model to which the scan, job or chunk in the path belongs.
struct ApiRoute {
  Method method = Method::kGet;
  std::string_view path;
  ApiHandler handler = nullptr;
  Executor executor = Executor::kInline;
  Role role = Role::kNone;
  ApiQuickHandler quick = nullptr;
  BodyKind body = BodyKind::kJson;
  ApiOpeningFinder opens = nullptr;
  RouteDoc doc = {};
};

// Returns the routes in the form that the HTTP server takes. `services` must outlive the result.
std::vector<Route> bind(std::span<const ApiRoute> routes, Services& services);

}  // namespace vitrine::server
