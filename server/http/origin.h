// SPDX-License-Identifier: Apache-2.0
// Which pages may open a stream: CORS does not guard WebSockets (RFC 6455, 10.2).
#pragma once

#include <span>
#include <string>

#include "server/http/http_header.h"

namespace vitrine {

// Clients that are no browsers send no Origin and may connect, as may the daemon's own pages and
// those of an origin in `allowed` (exact matches). Pages of other origins may where nothing is in
// `allowed`, as they may read public models over HTTP, but not with a token.
bool is_allowed_origin(const RequestHeader& header, std::span<const std::string> allowed);

}  // namespace vitrine
