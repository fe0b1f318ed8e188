// SPDX-License-Identifier: Apache-2.0
#include "server/store/s3_address.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/content/percent_encoding.h"
#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

constexpr std::string_view kScheme = "s3://";

Unexpected wrong(std::string_view text, std::string_view why) {
  return fail(ErrorCode::kBadInput,
              fmt::format("'{}' {}; give, for example, s3://models?endpoint=https://s3.example.org",
                          text, why));
}

// Removes the part before `mark`, and the mark itself, from `text`. Returns that part.
std::string_view take_until(std::string_view& text, char mark) {
  const std::string_view taken = text.substr(0, text.find(mark));
  text.remove_prefix(std::min(text.size(), taken.size() + 1));
  return taken;
}

bool set(S3Address& address, std::string_view name, std::string_view value) {
  if (name == "endpoint") {
    address.origin = origin_of(value);
    return !address.origin.empty() && address.origin.size() + 1 >= value.size();
  }
  if (name == "region") {
    address.region = value;
    return !value.empty() && std::ranges::all_of(value, is_unreserved);
  }
  address.is_virtual = value == "virtual";
  return name == "style" && (value == "virtual" || value == "path");
}

}  // namespace

Expected<S3Address> S3Address::parse(std::string_view text) {
  if (!text.starts_with(kScheme)) return wrong(text, "does not begin with s3://");
  std::string_view query = text.substr(kScheme.size());
  std::string_view prefix = take_until(query, '?');
  S3Address address{.bucket = std::string(take_until(prefix, '/')),
                    .prefix = std::string(prefix),
                    .region = "us-east-1"};
  const auto fits = [](char c) { return is_unreserved(c) || c == '/'; };
  if (address.bucket.empty() || !std::ranges::all_of(address.bucket, is_unreserved))
    return wrong(text, "names no bucket");
  if (!std::ranges::all_of(address.prefix, fits))
    return wrong(text, "has a prefix with characters other than letters, digits and -._~/");
  if (!address.prefix.empty() && !address.prefix.ends_with('/')) address.prefix += '/';
  address.is_virtual = query.find("endpoint=") == std::string_view::npos;
  while (!query.empty()) {
    std::string_view value = take_until(query, '&');
    const std::string_view name = take_until(value, '=');
    if (!set(address, name, value))
      return wrong(text, fmt::format("has an invalid value of '{}'", name));
  }
  if (address.origin.empty())
    address.origin = fmt::format("https://s3.{}.amazonaws.com", address.region);
  return address;
}

std::string S3Address::url_of(std::string_view key, std::string_view query) const {
  const std::size_t host = origin.find("//") + 2;
  std::string url = is_virtual ? fmt::format("{}{}.{}/", std::string_view(origin).substr(0, host),
                                             bucket, std::string_view(origin).substr(host))
                               : fmt::format("{}/{}", origin, bucket);
  if (!key.empty()) url += fmt::format("{}{}{}", is_virtual ? "" : "/", prefix, key);
  if (!query.empty()) url += fmt::format("?{}", query);
  return url;
}

}  // namespace vitrine::server
