// SPDX-License-Identifier: Apache-2.0
#include "server/config/endpoint.h"

#include <fmt/format.h>
#include <sys/un.h>

#include "codec/core/parse_number.h"
#include "server/config/host_names.h"

namespace vitrine::server {
namespace {

Expected<Endpoint> parse_unix_socket(std::string_view path) {
  if (path.empty() || path.size() >= sizeof(sockaddr_un::sun_path)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not the path of a socket; give a path of 1 to {} bytes", path,
                            sizeof(sockaddr_un::sun_path) - 1));
  }
  return Endpoint{.path = std::string(path)};
}

}  // namespace

Expected<Endpoint> parse_endpoint(std::string_view text) {
  constexpr std::string_view kUnix = "unix:";
  if (text.starts_with(kUnix)) return parse_unix_socket(text.substr(kUnix.size()));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not HOST:PORT; give, for example, 127.0.0.1:8080", text));
  }
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host == "localhost") host = "127.0.0.1";
  if (!is_address(host.substr(0, host.find('%')))) {  // ignores an IPv6 zone, as in fe80::1%eth0
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not a numeric address; give, for example, 127.0.0.1 or [::1]", host));
  }
  const std::string_view number = text.substr(colon + 1);
  const auto port = parse_number<std::uint16_t>(number);
  if (!port) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a whole number from 0 to 65535; correct it", number));
  }
  return Endpoint{.host = std::string(host), .port = *port};
}

}  // namespace vitrine::server
