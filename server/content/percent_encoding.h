// SPDX-License-Identifier: Apache-2.0
// Percent-encodes texts for URLs and header fields ([RFC3986] section 2.1).
#pragma once

#include <string>
#include <string_view>

namespace vitrine::server {

// Whether a character needs no encoding: a letter, a digit or one of "-._~".
bool is_unreserved(char c);

// Returns the text with all bytes except letters, digits and "-._~" replaced by %XX.
std::string percent_encoded(std::string_view text);

}  // namespace vitrine::server
