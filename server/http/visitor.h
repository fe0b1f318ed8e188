// SPDX-License-Identifier: Apache-2.0
// Who asks, and how, where proxies stand between. Only what a trusted proxy says is believed.
#pragma once

#include <string>
#include <string_view>

#include "server/config/networks.h"
#include "server/http/http_header.h"

namespace vitrine {

struct Visitor {
  std::string address;     // in digits, or "unix"
  bool encrypted = false;  // between the visitor and the first proxy, as far as we are told
};

// `peer` is the other end of the connection. Where it is trusted, X-Forwarded-For is read from its
// end, or else Forwarded (RFC 7239): the first address that is not itself a trusted proxy's is the
// visitor's. What does not parse ends the search. X-Forwarded-Proto, or Forwarded's proto=, says
// whether the visitor came by https.
Visitor visitor_of(Visitor peer, const RequestHeader& header, const Networks& proxies);

}  // namespace vitrine
