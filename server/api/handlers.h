// SPDX-License-Identifier: Apache-2.0
// Declares the handlers that tests also call directly. They answer GET; the server derives the
// responses to HEAD, conditional requests and range requests.
#pragma once

#include "server/api/routes.h"

namespace vitrine::server {

Response show_openapi(const Request& request, Services& services);
Response show_job_events(const Request& request, Services& services);
Response show_asset(const Request& request, Services& services);

}  // namespace vitrine::server
