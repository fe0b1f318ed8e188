// SPDX-License-Identifier: Apache-2.0
#include "server/config/networks.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "codec/core/parse_number.h"

namespace vitrine::server {
namespace {

constexpr std::array<std::uint8_t, 12> kMapped = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

std::string_view bare(std::string_view text) {
  while (text.starts_with(' '))
    text.remove_prefix(1);
  while (text.ends_with(' '))
    text.remove_suffix(1);
  return text;
}

bool begin_alike(const std::array<std::uint8_t, 16>& a, const std::array<std::uint8_t, 16>& b,
                 unsigned bits) {
  const unsigned whole = bits / 8;
  const unsigned rest = bits % 8 == 0 ? 0 : 0xFFu << (8 - bits % 8);
  return std::equal(a.begin(), a.begin() + whole, b.begin()) &&
         (rest == 0 || ((a[whole] ^ b[whole]) & rest & 0xFF) == 0);
}

}  // namespace

bool Networks::parse_address(std::string_view text, Address& out, unsigned& most_bits) {
  const std::string zeroed(text);
  out = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
  most_bits = 32;
  if (::inet_pton(AF_INET, zeroed.c_str(), out.data() + 12) == 1) return true;
  most_bits = 128;
  return ::inet_pton(AF_INET6, zeroed.c_str(), out.data()) == 1;
}

Expected<void> Networks::add(std::string_view network) {
  if (network == "unix") {
    has_unix_ = true;
    return {};
  }
  const std::string_view address = network.substr(0, network.find('/'));
  const std::string_view bits = network.substr(std::min(network.size(), address.size() + 1));
  NetworkPrefix prefix{};
  unsigned most = 0;
  const bool known = parse_address(address, prefix.address, most);
  const bool whole = address.size() == network.size();
  const auto length = whole ? most : parse_number<unsigned>(bits);
  if (!known || !length || *length > most) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a network; give, for example, 10.0.0.0/8", network));
  }
  prefix.bits = 128 - most + *length;
  prefixes_.push_back(prefix);
  return {};
}

Expected<Networks> Networks::parse(std::string_view list) {
  Networks networks;
  while (!list.empty()) {
    const std::string_view one = list.substr(0, list.find(','));
    if (auto added = networks.add(bare(one)); !added) return tl::unexpected(added.error());
    list.remove_prefix(std::min(list.size(), one.size() + 1));
  }
  return networks;
}

bool Networks::contain(std::string_view address) const {
  if (address == "unix") return has_unix_;
  Address bytes;
  unsigned most = 0;
  return !prefixes_.empty() && parse_address(address, bytes, most) &&
         std::ranges::any_of(prefixes_, [&](const NetworkPrefix& prefix) {
           return begin_alike(prefix.address, bytes, prefix.bits);
         });
}

namespace {

// Returns the network prefix of an address as text. Appends a slash and the number of bits if the
// prefix is shorter than the address. Returns text that is not an address unchanged.
std::string prefix_of(std::string_view address, unsigned ipv4_bits, unsigned ipv6_bits) {
  const std::string zeroed(address);
  std::array<std::uint8_t, 16> bytes{};
  const bool is_ipv4 = ::inet_pton(AF_INET, zeroed.c_str(), bytes.data() + kMapped.size()) == 1;
  if (!is_ipv4 && ::inet_pton(AF_INET6, zeroed.c_str(), bytes.data()) != 1) return zeroed;
  const bool is_short = is_ipv4 || std::equal(kMapped.begin(), kMapped.end(), bytes.begin());
  const auto begin = bytes.begin() + (is_short ? kMapped.size() : 0);
  const unsigned bits = is_short ? ipv4_bits : ipv6_bits;
  std::fill(begin + bits / 8, bytes.end(), std::uint8_t{0});
  char text[INET6_ADDRSTRLEN] = "";
  ::inet_ntop(is_short ? AF_INET : AF_INET6, &*begin, text, sizeof text);
  return is_short && bits == 32 ? text : fmt::format("{}/{}", text, bits);
}

}  // namespace

std::string network_of(std::string_view address) {
  return prefix_of(address, 32, 64);
}

std::string shortened(std::string_view address) {
  return prefix_of(address, 24, 48);
}

bool is_address(std::string_view text) {
  const std::string zeroed(text);
  in6_addr parsed;
  return ::inet_pton(AF_INET, zeroed.c_str(), &parsed) == 1 ||
         ::inet_pton(AF_INET6, zeroed.c_str(), &parsed) == 1;
}

}  // namespace vitrine::server
