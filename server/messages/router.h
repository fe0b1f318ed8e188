// SPDX-License-Identifier: Apache-2.0
// Finds the route for a request's path and method. A parameter in a path must match the pattern
// that the application defines for it, so handlers receive only values that match a pattern.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/auth/authenticator.h"
#include "server/messages/http_header.h"
#include "server/messages/response.h"

namespace vitrine::server {

// A parameter, and the function that decides which texts may replace `{name}` in the path of a
// route.
struct ParameterPattern {
  std::string_view name;
  bool (*matches)(std::string_view text);
};

// The texts that replace the parameters of a route in the path of one request.
class PathParameters {
 public:
  static constexpr std::size_t kMost = 4;  // largest number of parameters in one path

  // Returns the text that replaces `{name}`. The path of the request's route must contain `{name}`.
  std::string_view operator[](std::string_view name) const;

  // Adds a parameter. Returns false if there are kMost parameters already.
  bool add(std::string_view name, std::string_view text);

 private:
  std::array<std::pair<std::string_view, std::string_view>, kMost> values_{};
  std::size_t count_ = 0;
};

struct Request {
  const RequestHeader& header;
  std::string_view path;   // path as sent, without the query
  std::string_view query;  // query as sent
  PathParameters parameters;
  std::string_view id;
  const nlohmann::json& body;  // a JSON object; empty if the request has no JSON body
  const std::string& form;     // the body of a route that takes a form, as sent
  // The owner of the request's token, or nullopt if there is no token or it was not checked. If the
  // route needs a role, its `handler` is called only for a caller that has the role.
  const std::optional<Caller>& caller;
  bool is_encrypted = false;             // whether the client uses HTTPS
  std::string_view client_address = {};  // see Client::address
  bool is_urgent = false;                // see server::is_urgent()
};

using Handler = std::function<Response(const Request& request)>;
// Answers from memory without blocking. Returns nullopt if the Handler must answer.
using QuickHandler = std::function<std::optional<Response>(const Request& request)>;

// A file that a handler needs and that takes long to open, because all of it is hashed.
struct Opening {
  std::string name;  // the same for all requests for this file
  std::function<bool()>
      open;  // opens the file before the handler runs; returns false if that fails
};
// Returns the file that must be opened before the Handler runs, or nullopt. May wait for the
// catalogue.
using OpeningFinder = std::function<std::optional<Opening>(const Request& request)>;

// The thread on which a handler runs.
enum class Executor : std::uint8_t {
  kInline,   // the connection's own thread: the handler uses memory and open files only
  kWorker,   // a worker thread: the handler may wait for the catalogue and read from the disk;
             // callers take turns
  kDisk,     // a thread for handlers that wait for durable writes or for the store's lock
  kCompute,  // a thread for long computations; callers take turns; one task per target at a time
  kDevice,   // a thread for handlers that wait for devices, for up to several seconds
  kUrgent,   // a thread for emergency stops only: no rate limit or queue delays them
};

// A kGet route also answers HEAD requests. If a path has no kOptions route, the server itself
// answers OPTIONS requests with the methods of the path.
enum class Method : std::uint8_t { kGet, kPost, kPatch, kDelete, kPut, kOptions };

// How the server treats the body of a POST, PATCH or PUT request.
enum class BodyKind : std::uint8_t {
  kJson,       // parses it as JSON into Request::body
  kForm,       // reads it into Request::form, encoded like a query
  kPieces,     // passes it to Response::sink
  kLargeJson,  // like kJson, with a larger limit; only for routes that need a role
};

struct Route {
  Method method = Method::kGet;
  // A template of literals and `{name}` parameters; `{rest}` at the end matches the rest of the
  // path.
  std::string_view path;
  Handler handler;
  // Optional. The server calls this function on the connection's thread before the caller is known.
  // If it returns nullopt and the caller is then authorised, the server calls it again, now with
  // the caller.
  QuickHandler quick;
  // Optional. Returns the file that the server opens before it calls `handler`. The request
  // meanwhile occupies no thread for handlers.
  OpeningFinder opens = {};
  Executor executor = Executor::kInline;
  Role role = Role::kNone;  // the lowest role that a caller needs; kNone: no token is needed
  BodyKind body = BodyKind::kJson;
};

// Whether this is the route of an emergency stop.
inline bool is_urgent(const Route& route) {
  return route.executor == Executor::kUrgent;
}

// Whether pages of other origins may read the responses of `route`.
inline bool is_public_read(const Route& route) {
  return route.method == Method::kGet && route.role == Role::kNone;
}

// Returns the distinct paths of `routes` in the order of their first occurrence.
template <class Routes>
std::vector<std::string_view> path_templates(const Routes& routes) {
  std::vector<std::string_view> templates;
  for (const auto& route : routes) {
    if (std::ranges::find(templates, route.path) == templates.end())
      templates.push_back(route.path);
  }
  return templates;
}

struct RouteMatch {
  std::size_t index;  // index of the first route that has the matching template
  PathParameters parameters;
};

class Router {
 public:
  // `patterns` must contain every parameter of the routes. A parameter without a pattern matches no
  // text.
  Router(std::vector<Route> routes, std::span<const ParameterPattern> patterns);

  std::span<const Route> routes() const { return routes_; }
  const std::vector<std::string_view>& templates() const { return templates_; }
  // Returns the template of a route, as an index into templates().
  std::size_t template_of(std::size_t route) const { return template_of_[route]; }

  // Returns the first route whose template matches `path`, or nullopt.
  std::optional<RouteMatch> match(std::string_view path) const;
  // Returns the route for `method` that has the template of `match`; nullopt if there is none.
  std::optional<std::size_t> find(const RouteMatch& match, Method method) const;
  // Whether the template of `match` ends with `{rest}`, so that any path matches it.
  bool is_catch_all(const RouteMatch& match) const {
    return routes_[match.index].path.ends_with("{rest}");
  }
  // Returns the value of the Allow field for the path of `match`.
  std::string allow(const RouteMatch& match) const;

 private:
  std::optional<PathParameters> match_template(std::string_view pattern,
                                               std::string_view path) const;
  bool is_accepted(std::string_view name, std::string_view text) const;

  const std::vector<Route> routes_;
  const std::span<const ParameterPattern> patterns_;
  const std::vector<std::string_view> templates_;
  std::vector<std::size_t> template_of_;
};

}  // namespace vitrine::server
