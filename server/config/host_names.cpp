// SPDX-License-Identifier: Apache-2.0
#include "server/config/host_names.h"

#include <algorithm>
#include <cctype>

namespace vitrine::server {
namespace {

bool is_port(std::string_view text) {
  return text.empty() || (text.front() == ':' && std::ranges::all_of(text.substr(1), [](char c) {
                            return c >= '0' && c <= '9';
                          }));
}

// Returns the host of "HOST:PORT", without brackets and without a final dot. Returns an empty text
// if `host` has another form.
std::string_view without_port(std::string_view host) {
  const bool has_brackets = host.starts_with('[');
  const std::size_t end = host.find(has_brackets ? ']' : ':');
  if (has_brackets && end == host.npos) return {};
  const std::string_view behind = end == host.npos ? "" : host.substr(has_brackets ? end + 1 : end);
  if (!is_port(behind)) return {};
  host = has_brackets ? host.substr(1, end - 1) : host.substr(0, end);
  if (host.ends_with('.')) host.remove_suffix(1);
  return host;
}

// Returns the host of a URL such as "https://museum.example:8443/path".
std::string_view host_of_url(std::string_view url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string_view::npos) return {};
  url.remove_prefix(scheme + 3);
  return without_port(url.substr(0, url.find('/')));
}

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char left, unsigned char right) {
    return std::tolower(left) == std::tolower(right);
  });
}

}  // namespace

bool is_own_host(const Settings& settings, std::string_view host) {
  if (host.empty()) return true;
  const std::string_view name = without_port(host);
  if (name.empty()) return false;
  const auto is_name = [name](std::string_view one) { return is_same_name(name, one); };
  return is_name("localhost") || is_address(name) || is_name(host_of_url(settings.public_url)) ||
         is_name(host_of_url(settings.scan_address)) ||
         std::ranges::any_of(settings.hosts, is_name);
}

bool is_trusted_origin(const Settings& settings, std::string_view origin) {
  return std::ranges::find(settings.allowed_origins, origin) != settings.allowed_origins.end();
}

bool is_public_host(const Settings& settings, std::string_view host) {
  const bool is_open = settings.hosts.empty() && settings.public_url.empty();
  return is_open || is_own_host(settings, host);
}

bool is_origin(std::string_view text) {
  const std::size_t scheme = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  const std::string_view host = text.substr(scheme);
  return scheme > 0 && !host.empty() && std::ranges::all_of(host, [](unsigned char c) {
           return std::islower(c) || std::isdigit(c) ||
                  std::string_view("-.:[]").find(static_cast<char>(c)) != std::string_view::npos;
         });
}

bool is_host_name(std::string_view text) {
  return text.size() <= 253 && std::ranges::all_of(text, [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_';
         });
}

}  // namespace vitrine::server
