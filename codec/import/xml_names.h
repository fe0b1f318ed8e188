// SPDX-License-Identifier: Apache-2.0
// Names of elements in an XML text.
#pragma once

#include <algorithm>
#include <string_view>

namespace vitrine::inline codec {

// Returns a name without the prefix of its XML namespace.
inline std::string_view local_name(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

// Returns the position at which `markup`, which begins with "<?" or "<!", ends. Returns npos if it
// does not end. A document type may contain declarations in brackets.
inline std::size_t end_of_markup(std::string_view markup) {
  const auto end_after = [&](std::string_view mark, std::size_t from) {
    const std::size_t at = markup.find(mark, from);
    return at == markup.npos ? at : at + mark.size();
  };
  if (markup.starts_with("<?")) return end_after("?>", 2);
  if (markup.starts_with("<!--")) return end_after("-->", 4);
  const std::size_t first = markup.find_first_of("[>");
  const bool has_brackets = first != markup.npos && markup[first] == '[';
  const std::size_t from = has_brackets ? markup.find(']', first) : first;
  return from == markup.npos ? from : end_after(">", from);
}

// Returns the name of the root element at the start of an XML text. Skips comments, declarations
// and the document type. Returns an empty name if there is no element.
inline std::string_view root_name(std::string_view xml) {
  while (true) {
    xml.remove_prefix(std::min(xml.find_first_not_of(" \t\r\n"), xml.size()));
    if (!xml.starts_with("<?") && !xml.starts_with("<!")) break;
    const std::size_t end = end_of_markup(xml);
    if (end == xml.npos) return {};
    xml.remove_prefix(end);
  }
  if (!xml.starts_with('<')) return {};
  return xml.substr(1, std::min(xml.find_first_of(" \t\r\n/>"), xml.size()) - 1);
}

}  // namespace vitrine::inline codec
