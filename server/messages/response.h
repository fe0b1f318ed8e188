// SPDX-License-Identifier: Apache-2.0
// The response that a handler returns, and the function that formats its header.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/messages/body.h"
#include "server/messages/event_source.h"

namespace vitrine::server {

class BodySink;
class Upgrade;

enum class Caching {
  kNever,       // no-store: never cached
  kPrivate,     // private, no-store: only for this caller; pages of other origins may not read it
  kRevalidate,  // no-cache: stored, but revalidated before each use
  // The content of this URL never changes. Browsers keep it for a year. Shared caches revalidate it
  // after two minutes, because the content may be withdrawn (s-maxage of [RFC9111]; [RFC5861]).
  kImmutable,
  // For a fault that replaces an earlier kImmutable response. Shared caches store it in place of
  // their copy and revalidate it after one second; browsers, before each use.
  kReplacesCopy,
};

struct Response {
  unsigned status = 200;
  std::string type;  // media type of the body; empty if there is no body
  Caching caching = Caching::kNever;
  std::string etag;  // a strong entity tag including its quotes; empty if there is none
  // Whether pages of other sites may show this page in a frame.
  bool is_embeddable = false;
  std::vector<std::pair<std::string_view, std::string>> fields;  // further header fields
  Body body;
  // If set, the response is a stream of the events of this source, `body` is unused and `status` is
  // 200. The connection closes after the last event.
  std::shared_ptr<EventSource> events;
  // If set, receives the request's body, which has not been read yet, and then makes the response
  // that replaces this one.
  std::shared_ptr<BodySink> sink;
  // If set, takes over the connection, and `status` is 101.
  std::shared_ptr<Upgrade> upgrade;
};

// Returns a response with status 200 and this body, which caches must revalidate. Its ETag is a
// hash of the body.
Response revalidated(std::string_view type, std::string body);

// Returns the strong entity tag of a body: its hash in quotes.
std::string entity_tag(std::string_view body);

struct HeadOptions {
  std::string_view request_id;
  bool keeps_alive = true;
  bool is_public_read = true;  // whether pages of any origin may read and embed the response
  // an origin whose pages may read the response; empty if there is none
  std::string_view trusted_origin = {};
  // HTTP version of the request, such as 11 for HTTP/1.1. An HTTP/1.0 connection stays open only if
  // both sides ask for it.
  unsigned version = 11;
  // Whether the connection uses TLS. If so, Strict-Transport-Security is sent.
  bool is_encrypted = false;
};

// Adds the name of a request field to the Vary field of the response. Vary lists the request fields
// that determine which representation the server sends ([RFC9110] section 12.5.5).
void add_vary(Response& response, std::string_view name);

// Returns the status line and the header fields, up to and including the empty line.
std::string response_head(const Response& response, const HeadOptions& options);

}  // namespace vitrine::server
