// SPDX-License-Identifier: Apache-2.0
#include "server/messages/content_coding.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>

namespace vitrine::server {
namespace {

using boost::beast::iequals;

constexpr std::string_view kBlanks = " \t";

// Removes the text before the next `separator`, and the separator, from `text`. Returns the removed
// text without surrounding blanks.
std::string_view take_item(std::string_view& text, char separator) {
  std::string_view item = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), item.size() + 1));
  item.remove_prefix(std::min(item.size(), item.find_first_not_of(kBlanks)));
  return item.substr(0, item.find_last_not_of(kBlanks) + 1);
}

// Whether the parameters of a coding allow its use. False if the weight is 0 or malformed.
bool is_welcome(std::string_view parameters) {
  const std::string_view weight = take_item(parameters, ';');
  if (weight.empty()) return true;
  const std::string_view value = weight.substr(std::min<std::size_t>(weight.size(), 2));
  return iequals(weight.substr(0, 2), "q=") &&
         value.find_first_of("123456789") != std::string_view::npos &&
         value.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
  bool accepts_any = false;
  while (!accept_encoding.empty()) {
    std::string_view item = take_item(accept_encoding, ',');
    const std::string_view coding = take_item(item, ';');
    if (iequals(coding, "gzip")) return is_welcome(item);
    if (coding == "*") accepts_any = is_welcome(item);
  }
  return accepts_any;
}

}  // namespace vitrine::server
