// SPDX-License-Identifier: Apache-2.0
// What a client can unpack (RFC 9110, section 12.5.3).
#pragma once

#include <string_view>

namespace vitrine {

// Whether gzip is welcome by an Accept-Encoding of that value. Empty, or anything that is no such
// list: it is not.
bool accepts_gzip(std::string_view accept_encoding);

}  // namespace vitrine
