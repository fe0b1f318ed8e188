// SPDX-License-Identifier: Apache-2.0
#include "server/http/response.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <iterator>

#include "codec/core/sha256.h"
#include "server/http/http_header.h"

namespace vitrine {
namespace {

std::string_view cache_control(Caching caching) {
  switch (caching) {
    case Caching::kNever:
      return "no-store";
    case Caching::kPrivate:
      return "private, no-store";
    case Caching::kRevalidate:
      return "no-cache";
    case Caching::kImmutable:
      return "public, max-age=31536000, immutable";
  }
  return "";
}

// The Date field's value (RFC 9110, 5.6.7), made once a second.
std::string_view http_date() {
  thread_local std::time_t made = 0;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now != made) {
    made = now;
    text = fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(now));
  }
  return text;
}

std::string_view reason(unsigned status) {
  const auto text = beast::http::obsolete_reason(static_cast<beast::http::status>(status));
  return {text.data(), text.size()};
}

}  // namespace

Response revalidated(std::string_view type, std::string body) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(body.data());
  Response response;
  response.type = type;
  response.caching = Caching::kRevalidate;
  response.etag = '"' + to_hex(sha256({bytes, body.size()})) + '"';
  response.body = std::move(body);
  return response;
}

std::string response_head(const Response& response, const HeadOptions& options) {
  std::string head;
  head.reserve(512);
  const auto out = std::back_inserter(head);
  fmt::format_to(out, "HTTP/1.1 {} {}\r\nDate: {}\r\nServer: vitrine\r\nX-Request-Id: {}\r\n",
                 response.status, reason(response.status), http_date(), options.request_id);
  if (!response.type.empty()) fmt::format_to(out, "Content-Type: {}\r\n", response.type);
  if (response.status != 204 && response.status != 304 && !response.events) {
    fmt::format_to(out, "Content-Length: {}\r\n", body_size(response.body));
  }
  fmt::format_to(out, "Cache-Control: {}\r\n", cache_control(response.caching));
  if (!response.etag.empty()) {
    fmt::format_to(out, "ETag: {}\r\nAccept-Ranges: bytes\r\n", response.etag);
  }
  if (options.public_read) {
    head +=
        "Access-Control-Allow-Origin: *\r\n"
        "Access-Control-Expose-Headers: Content-Range, ETag, Link, X-Request-Id\r\n"
        "Cross-Origin-Resource-Policy: cross-origin\r\n";
  }
  head += "X-Content-Type-Options: nosniff\r\n";
  for (const auto& [name, value] : response.fields)
    fmt::format_to(out, "{}: {}\r\n", name, value);
  if (!options.keep_alive) {
    head += "Connection: close\r\n";
  } else if (options.version < 11) {
    head += "Connection: keep-alive\r\n";
  }
  head += "\r\n";
  return head;
}

}  // namespace vitrine
