// SPDX-License-Identifier: Apache-2.0
// Checks texts from clients before they are shown to people.
#pragma once

#include <string_view>

namespace vitrine::server {

// Whether `text` is well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates) without control
// characters.
bool is_plain_text(std::string_view text) noexcept;

}  // namespace vitrine::server
