// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/doctor/finding.h"

namespace vitrine {

// A server as a visitor meets it at `url`, through proxies: certificate, clock, CORS, entity tags,
// ranges, caching, WebSocket; with a `token` of a viewer's role or more, its scanners, too.
Findings check_server(const std::string& url, const std::string& token);

}  // namespace vitrine
