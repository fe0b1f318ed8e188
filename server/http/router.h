// SPDX-License-Identifier: Apache-2.0
// Finds the route of a path and a method. Parameters are parsed to their types on the way: a path
// whose parameter does not parse matches no route, and no handler ever sees a visitor's text as an
// id.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/sha256.h"
#include "server/auth/authenticator.h"
#include "server/catalogue/model_id.h"
#include "server/http/http_header.h"
#include "server/http/response.h"

namespace vitrine {

struct Services;

struct PathParameters {
  ModelId id;                // {id}
  Sha256 sha256{};           // {sha256}
  std::string_view format;   // {format}: lower-case letters, not empty
  std::string_view name;     // {name}: 1 to 32 of a-z, 0-9 and '-'
  std::uint32_t number = 0;  // {number}: 1 to 999999, no leading zero
};

struct Request {
  const RequestHeader& header;
  std::string_view path;   // without the query, as sent
  std::string_view query;  // as sent
  PathParameters parameters;
  std::string_view id;         // the request id
  const nlohmann::json& body;  // an object; empty where the request has none
  // Whose token it is. Where the route asks for a role, there is one, and its role suffices.
  const std::optional<Caller>& caller;
  bool encrypted = false;         // the visitor came by https
  std::string_view visitor = {};  // their address, as Visitor::address
  bool urgent = false;            // as its Route
};

using Handler = Response (*)(const Request& request, Services& services);
// Answers from memory at once, or not at all: then the handler is asked.
using QuickHandler = std::optional<Response> (*)(const Request& request, Services& services);

// Where a handler runs.
enum class Place : std::uint8_t {
  kInline,  // on the connection's own thread: it touches memory and open files only
  kWorker,  // on a worker thread: it may wait for the catalogue, and read from the disk
  kDisk,    // on a thread for what waits until the disk has it, or for the store's lock
  kExport,  // on a worker thread, one at a time per target: it computes for long
  kDevice,  // on a thread for what waits for devices: it may do so for seconds
};

// kGet answers HEAD as well. What a path takes is told without a route for kOptions.
enum class Method : std::uint8_t { kGet, kPost, kPatch, kDelete, kOptions };

struct Route {
  Method method;
  std::string_view path;  // a template: literals, {rest} (all that is left) and PathParameters
  Handler handler;
  Place place;
  Role role = Role::kNone;  // the least that a caller needs; kNone: everybody may
  // Tried on the connection's own thread: first for everybody, and again once a caller is known.
  QuickHandler quick = nullptr;
  bool reads_body = true;  // of a POST or PATCH: JSON; else it does not matter, or goes
                           // where the answer's sink is
  bool urgent = false;     // an emergency stop: neither limited by request-rate nor, where another
                           // daemon is to answer, behind who else waits for one
};

// Whether other origins' pages may read the answers.
inline bool is_public_read(const Route& route) {
  return route.method == Method::kGet && route.role == Role::kNone;
}

struct RouteMatch {
  std::size_t index;  // of the first route with the path's template
  PathParameters parameters;
};

class Router {
 public:
  explicit Router(std::span<const Route> routes);

  std::span<const Route> routes() const { return routes_; }
  const std::vector<std::string_view>& templates() const { return templates_; }
  // The route's template, as an index into templates().
  std::size_t template_of(std::size_t route) const { return template_of_[route]; }

  std::optional<RouteMatch> match(std::string_view path) const;  // the first that fits
  // The route for `method` with the template of `match`.
  std::optional<std::size_t> find(const RouteMatch& match, Method method) const;
  // Whether `match` tells nothing of what is at the path.
  bool is_for_what_is_left(const RouteMatch& match) const {
    return routes_[match.index].path.ends_with("{rest}");
  }
  // The value of the Allow field of what `match` has matched.
  std::string allow(const RouteMatch& match) const;

 private:
  std::span<const Route> routes_;
  std::vector<std::string_view> templates_;  // each once: routes share one by their methods
  std::vector<std::size_t> template_of_;
};

}  // namespace vitrine
