// SPDX-License-Identifier: Apache-2.0
// Inserts texts into the pages of the web client.
#pragma once

#include <string>
#include <string_view>

#include "codec/core/html.h"

namespace vitrine::server {

// Inserts `text` after the first occurrence of `place`. Without `place`, `html` stays as it is.
inline void insert_after(std::string& html, std::string_view place, std::string_view text) {
  if (const auto at = html.find(place); at != html.npos) html.insert(at + place.size(), text);
}

// Replaces the text of the element `title`, unless `title` is empty.
inline void replace_title(std::string& html, std::string_view title) {
  const std::size_t begin = html.find("<title>"), end = html.find("</title>");
  if (!title.empty() && begin < end && end != html.npos)
    html.replace(begin, end - begin, "<title>" + escape_html(title));
}

}  // namespace vitrine::server
