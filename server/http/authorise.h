// SPDX-License-Identifier: Apache-2.0
// Authorises requests: checks a bearer token [RFC6750] against the role of a route.
#pragma once

#include <optional>

#include "server/http/http_server.h"
#include "server/messages/router.h"

namespace vitrine::server {

// The credentials of one request.
struct Credentials {
  const RequestHeader& header;
  std::string_view remote;  // the client's IP address
  std::string_view request_id;
};

// Whether authorise() must be called for the request: if the route needs a role, or if the request
// has a token and the handler does not run on the connection's own thread.
bool needs_authorisation(const Route& route, const RequestHeader& header);

struct Authorisation {
  // The owner of the request's token; nullopt if the request has no valid token.
  std::optional<Caller> caller;
  // The response if the request is refused: 401 if there is no valid token, 403 if the token's role
  // does not suffice, 429 if this address has sent too many unknown tokens, 503 if the catalogue
  // cannot be read.
  std::optional<Response> refusal;
};
// Authorises a request. May block to read the catalogue.
Authorisation authorise(const Route& route, const Credentials& credentials,
                        const HttpDependencies& with);
// Authorises a request without blocking. Returns nullopt if the catalogue must be read.
std::optional<Authorisation> authorise_at_once(const Route& route, const Credentials& credentials,
                                               const HttpDependencies& with);

}  // namespace vitrine::server
