// SPDX-License-Identifier: Apache-2.0
// Declares API functions that other files call directly: handlers that tests call, and
// make_posters(). The handlers answer GET requests; the server derives the responses to HEAD,
// conditional requests and range requests.
#pragma once

#include "server/api/routes.h"

namespace vitrine::server {

Response show_openapi(const Request& request, Services& services);
Response show_job_events(const Request& request, Services& services);
Response show_asset(const Request& request, Services& services);

// Puts the posters of a model into the cache, so that the model's first visitors do not wait for
// them. If a poster cannot be made, still makes the others, and then fails. The first request for
// the missing poster tries to make it again.
Expected<void> make_posters(const ModelId& id, Services& services);

}  // namespace vitrine::server
