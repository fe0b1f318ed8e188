// SPDX-License-Identifier: Apache-2.0
// Guards against request smuggling, which exploits a disagreement between two parsers on where a
// request ends. A request with ambiguous framing is answered with 400 and the connection is closed,
// even if the HTTP library accepts the request.
#pragma once

#include <string_view>

#include "server/messages/http_header.h"

namespace vitrine::server {

// Returns the fault in a request's framing, or "" if the framing is unambiguous ([RFC9112] sections
// 3.2 and 6.1 to 6.3, read strictly). Faults are:
// - Transfer-Encoding together with Content-Length;
// - Transfer-Encoding that is given twice, is not exactly "chunked", or occurs in HTTP/1.0;
// - more than one Content-Length, even with equal values, or a value that is not only digits;
// - no Host in HTTP/1.1, or more than one.
std::string_view framing_fault(const RequestHeader& header);

}  // namespace vitrine::server
