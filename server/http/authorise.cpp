// SPDX-License-Identifier: Apache-2.0
#include "server/http/authorise.h"

#include <fmt/format.h>

#include "server/auth/role.h"
#include "server/config/networks.h"
#include "server/messages/problem.h"

namespace vitrine::server {
namespace {

using beast::http::field;

Response unauthorised(std::string_view detail, std::string_view challenge,
                      std::string_view request_id) {
  Response response = problem(401, detail, request_id);
  response.fields = {{"WWW-Authenticate", std::string(challenge)}};
  return response;
}

Response unknown_token(const Credentials& credentials, const HttpDependencies& with) {
  with.metrics.unknown_tokens.fetch_add(1, std::memory_order_relaxed);
  const auto wait = with.tokens.throttle().failed(network_of(credentials.remote));
  if (wait.count() == 0) {
    return unauthorised("the token is unknown or revoked; ask for a new one",
                        "Bearer error=\"invalid_token\"", credentials.request_id);
  }
  Response response = problem(429, "too many unknown tokens; wait", credentials.request_id);
  response.fields = {{"Retry-After", fmt::format("{}", wait.count())}};
  return response;
}

// Returns the token of a field "Authorization: Bearer TOKEN". Returns an empty text if this field
// is missing, occurs twice, or has another form.
std::string_view bearer_token(const RequestHeader& header) {
  constexpr std::string_view kScheme = "Bearer ";
  const auto value = header[field::authorization];
  if (header.count(field::authorization) != 1 || value.size() <= kScheme.size() ||
      !beast::iequals(value.substr(0, kScheme.size()), kScheme)) {
    return {};
  }
  const auto token = value.substr(kScheme.size());
  return {token.data(), token.size()};
}

Authorisation with_role(const Caller& caller, const Route& route, std::string_view request_id) {
  if (caller.role >= route.role) return {caller, {}};
  const auto detail = fmt::format("this needs a token with the role {}", name_of(route.role));
  return {caller, problem(403, detail, request_id)};
}

}  // namespace

bool needs_authorisation(const Route& route, const RequestHeader& header) {
  if (route.role != Role::kNone) return true;
  return route.executor != Executor::kInline && header.count(field::authorization) > 0;
}

Authorisation authorise(const Route& route, const Credentials& credentials,
                        const HttpDependencies& with) {
  const std::string_view id = credentials.request_id;
  if (credentials.header.count(field::authorization) == 0) {
    if (route.role == Role::kNone) return {};
    return {{}, unauthorised("send a token: Authorization: Bearer TOKEN", "Bearer", id)};
  }
  const auto caller = with.tokens.find(bearer_token(credentials.header));
  if (!caller) {
    with.events.event(Severity::kError, fmt::format("request {}: {}", id, caller.error().message));
    return {{}, away(id)};
  }
  if (!*caller) return {{}, unknown_token(credentials, with)};
  return with_role(**caller, route, id);
}

std::optional<Authorisation> authorise_at_once(const Route& route, const Credentials& credentials,
                                               const HttpDependencies& with) {
  const auto caller = with.tokens.cached(bearer_token(credentials.header));
  if (!caller) return std::nullopt;
  return with_role(*caller, route, credentials.request_id);
}

}  // namespace vitrine::server
