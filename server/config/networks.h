// SPDX-License-Identifier: Apache-2.0
// A list of networks: addresses, prefixes ("10.0.0.0/8", "fd00::/8"), and "unix" for
// clients on a Unix socket.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server {

class Networks {
 public:
  // Parses a list that is separated by commas. The error (kBadInput) names the entry that is not a
  // network.
  static Expected<Networks> parse(std::string_view list);

  // Whether the list contains `address`, which is a numeric IP address or "unix". Returns false for
  // any other text. Treats an IPv4 address and its IPv6-mapped form as equal.
  bool contain(std::string_view address) const;

 private:
  using Address = std::array<std::uint8_t, 16>;
  struct NetworkPrefix {
    Address address;
    unsigned bits;
  };
  static bool parse_address(std::string_view text, Address& out, unsigned& most_bits);
  Expected<void> add(std::string_view network);

  std::vector<NetworkPrefix> prefixes_;
  bool has_unix_ = false;
};

// Returns the network whose clients share one budget in all limits. For IPv4, also in IPv6-mapped
// form, this is the address itself. For IPv6, it is the prefix of 64 bits, because the addresses in
// such a prefix belong to one subscriber ([RFC6177]). Returns text that is not an address
// unchanged.
std::string network_of(std::string_view address);

// Returns a shortened address for logs, so that a log identifies no person: the first 24 bits of an
// IPv4 address, even in IPv6-mapped form, or the first 48 bits of an IPv6 address. Returns text
// that is not an address unchanged.
std::string shortened(std::string_view address);

// Whether `text` is a numeric IPv4 or IPv6 address.
bool is_address(std::string_view text);

}  // namespace vitrine::server
