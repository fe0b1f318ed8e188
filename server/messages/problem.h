// SPDX-License-Identifier: Apache-2.0
// Formats errors as application/problem+json (RFC 9457).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/messages/response.h"

namespace vitrine::server {

struct ParameterFault {
  std::string parameter, detail;
};

// Returns an error response. `detail` explains the fault to the client. It is omitted for status
// 500 and above, since it may describe the server's internals; the log has it under the request ID.
// It is kept for 507 (insufficient storage), which the client can act on.
Response problem(unsigned status, std::string_view detail, std::string_view request_id,
                 const std::vector<ParameterFault>& errors = {});

// Returns 503 with Retry-After, for a resource or capacity that is temporarily unavailable.
Response away(std::string_view request_id);

}  // namespace vitrine::server
