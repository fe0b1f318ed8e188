// SPDX-License-Identifier: Apache-2.0
// Shows errors as HTML pages to people who open an address in a browser.
#pragma once

#include "server/messages/http_header.h"
#include "server/messages/response.h"

namespace vitrine::server {

// Whether the client is a browser that opens a page: a GET or HEAD request whose Accept field lists
// text/html and not JSON.
bool wants_page(const RequestHeader& request);

// Returns `problem` (application/problem+json) as an HTML page that states the next step. The page
// is in German if German comes first in the Accept-Language field, else in English. Keeps the
// status and the header fields.
Response problem_page(Response problem, const RequestHeader& request);

}  // namespace vitrine::server
