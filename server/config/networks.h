// SPDX-License-Identifier: Apache-2.0
// A list of networks: addresses, prefixes ("10.0.0.0/8", "fd00::/8"), and "unix" for whoever
// connects to a Unix socket.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

class Networks {
 public:
  // Separated by commas. kBadInput names what is no network.
  static Expected<Networks> parse(std::string_view list);

  // `address` in digits, or "unix"; what is neither is in none. An IPv4 address is the same as its
  // form within IPv6.
  bool contain(std::string_view address) const;

 private:
  using Address = std::array<std::uint8_t, 16>;
  struct Prefix {
    Address address;
    unsigned bits;
  };
  static bool parse_address(std::string_view text, Address& out, unsigned& most_bits);
  Expected<void> add(std::string_view network);

  std::vector<Prefix> prefixes_;
  bool unix_ = false;
};

// What limits count as one visitor: an IPv4 address (in either form), and the first 64 bits of an
// IPv6 address, since all that share them are one subscriber's (RFC 6177). What is no address stays
// as it is.
std::string network_of(std::string_view address);

// Whether `text` is an IPv4 or IPv6 address in digits.
bool is_address(std::string_view text);

}  // namespace vitrine
