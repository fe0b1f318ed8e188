// SPDX-License-Identifier: Apache-2.0
// Errors as application/problem+json (RFC 9457).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/response.h"

namespace vitrine {

struct ParameterFault {
  std::string parameter, detail;
};

// `detail` is for the client. From status 500 up it is left out but for 507 (no room), which those
// who upload can do something about: else the request id is all that a client learns, the log has
// the rest.
Response problem(unsigned status, std::string_view detail, std::string_view request_id,
                 const std::vector<ParameterFault>& errors = {});

// 503, and when to come back: what the answer is made of, or room for it, is not to be had now.
Response away(std::string_view request_id);

}  // namespace vitrine
