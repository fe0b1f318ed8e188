// SPDX-License-Identifier: Apache-2.0
// Finds the client of a request that came through proxies. Uses only headers of trusted proxies.
#pragma once

#include <string>
#include <string_view>

#include "server/config/networks.h"
#include "server/messages/http_header.h"

namespace vitrine::server {

struct Client {
  std::string address;        // the IP address, or "unix" for a client on a Unix socket
  bool is_encrypted = false;  // whether the client uses HTTPS, to this server or to a trusted proxy
};

// Returns the client of a request that arrived from `peer`. If `peer` is not a trusted proxy,
// returns it unchanged. Otherwise reads X-Forwarded-For or, in its absence, Forwarded [RFC7239]
// from the last item to the first. The client's address is the first address read that is not a
// trusted proxy. Stops early at a malformed item. X-Forwarded-Proto, or proto= of Forwarded, states
// whether the client uses HTTPS.
Client client_of(Client peer, const RequestHeader& header, const Networks& proxies);

}  // namespace vitrine::server
