// SPDX-License-Identifier: Apache-2.0
// Formats errors as application/problem+json [RFC9457].
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/messages/response.h"

namespace vitrine::server {

// Media type of the responses of problem().
inline constexpr std::string_view kProblemType = "application/problem+json";

struct ParameterFault {
  std::string parameter, detail;
};

// Returns an error response. `detail` explains the fault to the client. The response omits `detail`
// if the status is 500 or above, because the text may describe the server's internals; the log has
// the text under the request ID. Only 507 (insufficient storage) keeps `detail`, because the client
// can act on it.
Response problem(unsigned status, std::string_view detail, std::string_view request_id,
                 const std::vector<ParameterFault>& errors = {});

// Returns 503 with Retry-After, for a resource or capacity that is temporarily unavailable.
Response away(std::string_view request_id);

}  // namespace vitrine::server
