// SPDX-License-Identifier: Apache-2.0
// Tells which content codings a client accepts (RFC 9110, section 12.5.3).
#pragma once

#include <string_view>

namespace vitrine::server {

// Whether an Accept-Encoding field allows gzip. False if the value is empty or malformed.
bool accepts_gzip(std::string_view accept_encoding);

}  // namespace vitrine::server
