// SPDX-License-Identifier: Apache-2.0
// Escapes text for HTML and XML.
#pragma once

#include <string>
#include <string_view>

namespace vitrine::inline codec {

// Escapes UTF-8 text for use as element content or in a quoted attribute value.
inline std::string escape_html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace vitrine::inline codec
