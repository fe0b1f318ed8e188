// SPDX-License-Identifier: Apache-2.0
// Decides which web pages may open a stream. The server itself must decide this, because CORS does
// not apply to WebSockets ([RFC6455] section 10.2).
#pragma once

#include <span>
#include <string>

#include "server/messages/http_header.h"

namespace vitrine::server {

// Returns true if the request has no Origin field (the client is then not a browser), if its origin
// is the daemon's own, or if its origin is in `allowed` (exact match). If `allowed` is empty, also
// returns true for any other origin, but only if the request has no token: pages of these origins
// may read public models over HTTP anyway.
bool is_allowed_origin(const RequestHeader& header, std::span<const std::string> allowed);

}  // namespace vitrine::server
