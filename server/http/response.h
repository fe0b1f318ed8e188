// SPDX-License-Identifier: Apache-2.0
// What a handler returns, and its header as it goes over the wire.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/http/body.h"
#include "server/http/event_source.h"

namespace vitrine {

class BodySink;

enum class Caching {
  kNever,       // no-store
  kPrivate,     // private, no-store: for this caller alone, and for no page of another origin
  kRevalidate,  // no-cache: kept, but asked about each time
  kImmutable,   // for a year without asking: the URL names the content
};

struct Response {
  unsigned status = 200;
  std::string type;  // media type; empty where there is no body
  Caching caching = Caching::kNever;
  std::string etag;  // a strong entity tag with its quotes; empty: none
  std::vector<std::pair<std::string_view, std::string>> fields;  // further ones
  Body body;
  // Server-sent events instead of a body, until they end; then the connection does. For 200.
  std::shared_ptr<EventSource> events;
  // Takes the request's body, which nobody has read; its answer takes the place of this one.
  std::shared_ptr<BodySink> sink;
};

// 200 with a text that is kept and asked about each time: its ETag is its hash.
Response revalidated(std::string_view type, std::string body);

// The strong entity tag of a body.
std::string entity_tag(std::string_view body);

struct HeadOptions {
  std::string_view request_id;
  bool keep_alive = true;
  bool public_read = true;  // pages of any origin may embed it
  unsigned version = 11;    // of the request: HTTP/1.0 keeps a connection only where both say so
  bool encrypted = false;   // by us: then browsers are to insist on it
};

// The status line and the fields, up to and including the empty line.
std::string response_head(const Response& response, const HeadOptions& options);

}  // namespace vitrine
