// SPDX-License-Identifier: Apache-2.0
#include "server/messages/origin.h"

#include <algorithm>
#include <boost/beast/http/field.hpp>

namespace vitrine::server {

using boost::beast::http::field;

bool is_allowed_origin(const RequestHeader& header, std::span<const std::string> allowed) {
  const auto sent = header.count(field::origin);
  if (sent != 1) return sent == 0;
  const std::string origin(header[field::origin]);
  const std::string host(header[field::host]);
  if (origin == "http://" + host || origin == "https://" + host) return true;
  if (std::ranges::find(allowed, origin) != allowed.end()) return true;
  return allowed.empty() && header.count(field::authorization) == 0;
}

}  // namespace vitrine::server
