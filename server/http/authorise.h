// SPDX-License-Identifier: Apache-2.0
// Whether a request may have its route: bearer tokens (RFC 6750) against the route's role.
#pragma once

#include <optional>

#include "server/http/router.h"

namespace vitrine {

// What one request presents.
struct Credentials {
  const RequestHeader& header;
  std::string_view remote;  // the peer's address
  std::string_view request_id;
};

bool needs_authorisation(const Route& route, const RequestHeader& header);

struct Authorisation {
  std::optional<Caller> caller;     // nobody for a public route without a token
  std::optional<Response> refusal;  // 401 without a token in force, 403 where its role does not
                                    // suffice, 429 where the address has tried too many wrong ones
};
// Waits for the catalogue.
Authorisation authorise(const Route& route, const Credentials& credentials, Services& services);
// Nothing where the catalogue has to be asked.
std::optional<Authorisation> authorise_at_once(const Route& route, const Credentials& credentials,
                                               Services& services);

}  // namespace vitrine
