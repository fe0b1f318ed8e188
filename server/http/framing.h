// SPDX-License-Identifier: Apache-2.0
// The guard against request smuggling. A request whose end two parsers could see in different
// places is answered with 400 and the connection closed, whatever the HTTP library makes of it.
#pragma once

#include <string_view>

#include "server/http/http_header.h"

namespace vitrine {

// What is wrong with the request's framing, or "" where it is unambiguous (RFC 9112, 6.1 to 6.3
// and 3.2, read strictly):
// - Transfer-Encoding together with Content-Length, given twice, other than exactly "chunked", or
//   in HTTP/1.0;
// - more than one Content-Length (equal values too), or one that is not digits alone;
// - no Host in HTTP/1.1, or more than one.
std::string_view framing_fault(const RequestHeader& header);

}  // namespace vitrine
