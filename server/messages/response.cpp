// SPDX-License-Identifier: Apache-2.0
#include "server/messages/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <initializer_list>

#include "codec/core/sha256.h"
#include "server/messages/http_header.h"
#include "server/messages/timestamp.h"

namespace vitrine::server {
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
      return "public, max-age=31536000, immutable, s-maxage=120, stale-while-revalidate=60";
    case Caching::kReplacesCopy:
      return "public, max-age=0, s-maxage=1";
  }
  return "";
}

// Returns the value of the Date field ([RFC9110] section 5.6.7). Each thread formats it at most
// once per second.
std::string_view date_field() {
  thread_local std::time_t made = 0;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now != made) {
    made = now;
    text = http_date(now);
  }
  return text;
}

// Header fields of HTML pages. Their content security policy allows only scripts, workers,
// WebAssembly and connections of the daemon itself ('self' includes WebSockets). Markup in a
// model's title can therefore not run scripts. Pictures and sounds may come from other hosts by
// HTTPS, because notes on models refer to them.
constexpr std::string_view kPagePolicy =
    "Content-Security-Policy: default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; "
    "worker-src 'self' blob:; style-src 'self'; img-src 'self' blob: data: https:; "
    "media-src 'self' https:; "
    "connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'";

// Continues kPagePolicy for pages that no other site may show in a frame (clickjacking), because
// their buttons move motors and delete models.
constexpr std::string_view kNoFrames = "; frame-ancestors 'none'\r\nX-Frame-Options: DENY";

std::string_view reason(unsigned status) {
  if (status == 460) return "Checksum Mismatch";  // a status defined by tus 1.0.0
  const auto text = beast::http::obsolete_reason(static_cast<beast::http::status>(status));
  return {text.data(), text.size()};
}

void append(std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    text += part;
}

}  // namespace

std::string entity_tag(std::string_view body) {
  return '"' + to_hex(sha256({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()})) +
         '"';
}

Response revalidated(std::string_view type, std::string body) {
  Response response;
  response.type = type;
  response.caching = Caching::kRevalidate;
  response.etag = entity_tag(body);
  response.body = std::move(body);
  return response;
}

void add_vary(Response& response, std::string_view name) {
  const auto vary =
      std::ranges::find(response.fields, "Vary", [](const auto& field) { return field.first; });
  if (vary == response.fields.end()) {
    response.fields.emplace_back("Vary", name);
  } else {
    vary->second.append(", ").append(name);
  }
}

std::string response_head(const Response& response, const HeadOptions& options) {
  std::string head;
  head.reserve(1024);
  append(head, {"HTTP/1.1 ", fmt::format_int(response.status).c_str(), " ", reason(response.status),
                "\r\nDate: ", date_field(),
                "\r\nServer: vitrine\r\nX-Request-Id: ", options.request_id, "\r\n"});
  if (!response.type.empty()) append(head, {"Content-Type: ", response.type, "\r\n"});
  if (response.status != 204 && response.status != 304 && !response.events) {
    append(head, {"Content-Length: ", fmt::format_int(body_size(response.body)).c_str(), "\r\n"});
  }
  append(head, {"Cache-Control: ", cache_control(response.caching), "\r\n"});
  if (!response.etag.empty()) {
    append(head, {"ETag: ", response.etag, "\r\nAccept-Ranges: bytes\r\n"});
  }
  if (options.is_public_read) {
    head +=
        "Access-Control-Allow-Origin: *\r\n"
        "Access-Control-Expose-Headers: Content-Range, ETag, Link, "
        "Vitrine-Presentation, X-Request-Id\r\n"
        "Cross-Origin-Resource-Policy: cross-origin\r\n";
  } else if (!options.trusted_origin.empty()) {
    append(head, {"Access-Control-Allow-Origin: ", options.trusted_origin,
                  "\r\nAccess-Control-Expose-Headers: *\r\nVary: Origin\r\n"});
  }
  head += "X-Content-Type-Options: nosniff\r\n";
  if (response.type.starts_with("text/html"))
    append(head, {kPagePolicy, response.is_embeddable ? "" : kNoFrames,
                  "\r\nReferrer-Policy: strict-origin-when-cross-origin\r\n"});
  if (options.is_encrypted) head += "Strict-Transport-Security: max-age=31536000\r\n";
  for (const auto& [name, value] : response.fields)
    append(head, {name, ": ", value, "\r\n"});
  if (!options.keeps_alive) {
    head += "Connection: close\r\n";
  } else if (options.version < 11) {
    head += "Connection: keep-alive\r\n";
  }
  head += "\r\n";
  return head;
}

}  // namespace vitrine::server
