// SPDX-License-Identifier: Apache-2.0
#include "server/http/public_url.h"

#include <algorithm>
#include <cctype>

#include "server/http/services.h"

namespace vitrine {
namespace {

// A host and a port: nothing that would mean anything in HTML or JSON, or lead to another path.
bool is_host(std::string_view text) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == ':' ||
           c == '[' || c == ']';
  };
  return !text.empty() && text.size() <= 255 && std::ranges::all_of(text, fits);
}

}  // namespace

std::string origin_of(const Request& request, Services& services) {
  if (std::string url = services.settings.get()->public_url; !url.empty()) return url;
  const auto host = request.header[beast::http::field::host];
  const std::string_view text(host.data(), host.size());
  return is_host(text) ? (request.encrypted ? "https://" : "http://") + std::string(text)
                       : std::string();
}

}  // namespace vitrine
