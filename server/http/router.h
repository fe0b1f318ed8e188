// SPDX-License-Identifier: Apache-2.0
// Finds the route of a path. Parameters are parsed to their types on the way: a path whose
// parameter does not parse matches no route, and no handler ever sees a visitor's text as an id.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "codec/core/sha256.h"
#include "server/catalogue/model_id.h"
#include "server/http/http_header.h"
#include "server/http/response.h"

namespace vitrine {

struct Services;

struct PathParameters {
  ModelId id;               // {id}
  Sha256 sha256{};          // {sha256}
  std::string_view format;  // {format}: lower-case letters, not empty
};

struct Request {
  const RequestHeader& header;
  std::string_view path;   // without the query, as sent
  std::string_view query;  // as sent
  PathParameters parameters;
  std::string_view id;  // the request id
};

using Handler = Response (*)(const Request& request, Services& services);
// Answers from memory at once, or not at all: then the handler is asked.
using QuickHandler = std::optional<Response> (*)(const Request& request, Services& services);

// Where a handler runs.
enum class Place : std::uint8_t {
  kInline,  // on the connection's own thread: it touches memory and open files only
  kWorker,  // on a worker thread: it may wait for the catalogue or the disk
  kExport,  // on a worker thread, one at a time per target: it computes for long
};

struct Route {
  std::string_view
      path;  // a template: literals and {id}, {sha256}, {format}, {rest} (all that is left)
  Handler handler;
  Place place;
  QuickHandler quick = nullptr;  // tried first, on the connection's own thread
};

struct RouteMatch {
  std::size_t index;  // into the router's routes
  PathParameters parameters;
};

class Router {
 public:
  explicit Router(std::span<const Route> routes) : routes_(routes) {}

  std::span<const Route> routes() const { return routes_; }
  std::vector<std::string_view> templates() const;
  std::optional<RouteMatch> match(std::string_view path) const;  // the first that fits

 private:
  std::span<const Route> routes_;
};

}  // namespace vitrine
