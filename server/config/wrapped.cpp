// SPDX-License-Identifier: Apache-2.0
#include "server/config/help_text.h"

namespace vitrine::server {

std::string wrapped(std::string_view text, std::size_t indent) {
  constexpr std::size_t kColumns = 100;
  std::string lines;
  while (indent + text.size() > kColumns) {
    std::size_t space = text.rfind(' ', kColumns - indent);
    if (space == text.npos) space = text.find(' ');
    if (space == text.npos) break;
    lines.append(text.substr(0, space)).append("\n").append(indent, ' ');
    text.remove_prefix(space + 1);
  }
  return lines.append(text);
}

}  // namespace vitrine::server
