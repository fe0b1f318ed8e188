// SPDX-License-Identifier: Apache-2.0
// Decodes Base64 ([RFC4648] section 4).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

// Returns the decoded bytes. Returns nullopt if the text is malformed or not padded.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace vitrine::server
