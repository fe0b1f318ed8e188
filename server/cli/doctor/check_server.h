// SPDX-License-Identifier: Apache-2.0
// Checks a running server from outside.
#pragma once

#include <string>

#include "server/cli/doctor/finding.h"

namespace vitrine::server {

// Requests `url` as a visitor does, through proxies. Checks certificate, clock, CORS, entity tags,
// ranges, caching and WebSocket. With a `token` of at least the viewer role it also checks the
// scanners.
Findings check_server(const std::string& url, const std::string& token);

}  // namespace vitrine::server
