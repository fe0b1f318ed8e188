// SPDX-License-Identifier: Apache-2.0
// Names of elements in an XML text.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace vitrine::inline codec {

// Returns a name without the prefix of its XML namespace.
inline std::string_view local_name(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

// Returns the name of the root element at the start of an XML text. Skips comments and other
// declarations. Returns an empty name if there is no element.
inline std::string_view root_name(std::string_view xml) {
  constexpr std::array<std::array<std::string_view, 2>, 3> kSkipped{
      {{"<?", "?>"}, {"<!--", "-->"}, {"<!", ">"}}};
  while (true) {
    xml.remove_prefix(std::min(xml.find_first_not_of(" \t\r\n"), xml.size()));
    const auto* found = std::ranges::find_if(
        kSkipped, [&](const auto& marks) { return xml.starts_with(marks[0]); });
    if (found == kSkipped.end()) break;
    const std::size_t end = xml.find((*found)[1]);
    if (end == xml.npos) return {};
    xml.remove_prefix(end + (*found)[1].size());
  }
  if (!xml.starts_with('<')) return {};
  return xml.substr(1, std::min(xml.find_first_of(" \t\r\n/>"), xml.size()) - 1);
}

}  // namespace vitrine::inline codec
