// SPDX-License-Identifier: Apache-2.0
// Text as it stands in HTML and XML.
#pragma once

#include <string>
#include <string_view>

namespace vitrine {

// `text` in UTF-8, as the content of an element or the value of an attribute in quotes.
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

}  // namespace vitrine
