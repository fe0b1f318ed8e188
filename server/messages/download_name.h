// SPDX-License-Identifier: Apache-2.0
// Chooses the file name under which a browser saves a response.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::server {

// Returns the value of a Content-Disposition header [RFC6266] for a file TITLE.EXTENSION. `title`
// is UTF-8 from an untrusted source. Characters that are special in paths, control characters and
// characters that change the direction of text become `_`. Removes spaces and dots at both ends.
// The title is cut to 120 bytes, between characters. If nothing is left, the name is
// FALLBACK.EXTENSION.
//
// A name that is not ASCII is given twice: in ASCII with `_`, and in UTF-8 as filename* [RFC8187].
// `fallback` and `extension` must be letters, digits, '.', '-' and '_'.
std::string attachment_named(std::string_view title, std::string_view fallback,
                             std::string_view extension);

}  // namespace vitrine::server
