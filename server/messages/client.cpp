// SPDX-License-Identifier: Apache-2.0
#include "server/messages/client.h"

#include <algorithm>

namespace vitrine::server {
namespace {

std::string_view bare(std::string_view text) {
  constexpr std::string_view kBlank = " \t\"";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// Returns the values of all header fields with this name, in order, separated by commas.
std::string joined(const RequestHeader& header, std::string_view name) {
  std::string list;
  const auto fields = header.equal_range(beast::string_view(name.data(), name.size()));
  for (auto field = fields.first; field != fields.second; ++field) {
    if (!list.empty()) list += ',';
    list.append(field->value().data(), field->value().size());
  }
  return list;
}

// Removes the last item of a comma-separated list and returns it without surrounding blanks and
// quotes.
std::string_view take_last(std::string_view& list) {
  const std::size_t comma = list.rfind(',');
  const std::string_view last = list.substr(comma == list.npos ? 0 : comma + 1);
  list = list.substr(0, comma == list.npos ? 0 : comma);
  return bare(last);
}

// Removes the port from an address such as "192.0.2.1:80" or "[2001:db8::1]:80".
std::string_view without_port(std::string_view node) {
  if (node.starts_with('[')) return node.substr(1, std::min(node.find(']'), node.size()) - 1);
  const std::size_t colon = node.find(':');
  return colon != node.npos && colon == node.rfind(':') ? node.substr(0, colon) : node;
}

// Returns the value of `name` in one element of a Forwarded field, such as
// "for=192.0.2.1;proto=https".
std::string_view parameter(std::string_view element, std::string_view name) {
  while (!element.empty()) {
    const std::string_view pair = element.substr(0, element.find(';'));
    element.remove_prefix(std::min(element.size(), pair.size() + 1));
    const std::string_view key = bare(pair.substr(0, pair.find('=')));
    if (beast::iequals({key.data(), key.size()}, {name.data(), name.size()}))
      return bare(pair.substr(std::min(pair.size(), pair.find('=') + 1)));
  }
  return {};
}

}  // namespace

Client client_of(Client peer, const RequestHeader& header, const Networks& proxies) {
  if (!proxies.contain(peer.address)) return peer;
  const std::string addresses = joined(header, "X-Forwarded-For");
  const std::string elements = joined(header, "Forwarded");
  const std::string schemes = joined(header, "X-Forwarded-Proto");
  const bool old = !addresses.empty();
  std::string_view list = old ? addresses : elements;
  std::string_view scheme = schemes;
  scheme = take_last(scheme);
  while (proxies.contain(peer.address) && !list.empty()) {
    const std::string_view item = take_last(list);
    const std::string_view node = without_port(old ? item : parameter(item, "for"));
    if (!old && schemes.empty()) scheme = parameter(item, "proto");
    if (!is_address(node)) break;
    peer.address = node;
  }
  if (!scheme.empty()) peer.is_encrypted = beast::iequals({scheme.data(), scheme.size()}, "https");
  return peer;
}

}  // namespace vitrine::server
