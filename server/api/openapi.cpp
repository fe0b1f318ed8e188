// SPDX-License-Identifier: Apache-2.0
// Generates the OpenAPI document [OpenAPI] of /api/v1 from the routes and their RouteDoc members.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/api/services.h"
#include "server/auth/role.h"
#include "server/messages/content_coding.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPrefix = "/api/v1/";

constexpr std::string_view kAbout =
    "Models are progressive meshes: a head that is shown at once, and immutable chunks that refine "
    "it. Published models are public. Other requests need a token (`Authorization: Bearer "
    "TOKEN`) with the role in `x-role`. Every route with GET supports HEAD. Responses to GET have "
    "strong ETags and support If-None-Match, Range (one range) and If-Range, except those for "
    "scanners, scans and jobs. Requests without a token and with `Accept-Encoding: gzip` get "
    "public JSON from 1 KiB to 4 MiB, OBJ and VRML with gzip; ETag and Range then refer to the "
    "compressed body. Errors are RFC 9457 problems. Request bodies are JSON of at most 64 "
    "KiB; those of notes and tours, of at most 1 MiB.";

std::string_view name_of(Method method) {
  switch (method) {
    case Method::kGet:
      return "get";
    case Method::kPost:
      return "post";
    case Method::kPatch:
      return "patch";
    case Method::kDelete:
      return "delete";
    case Method::kPut:
      return "put";
    case Method::kOptions:
      break;
  }
  return "";
}

Json ref(std::string_view kind, std::string_view name) {
  return {{"$ref", fmt::format("#/components/{}/{}", kind, name)}};
}

// Returns the OpenAPI `content` object of a body. `answer` is the name of the body's schema, or a
// list of media types separated by spaces. Client generators treat `format: binary` as raw bytes.
Json content(std::string_view answer) {
  if (answer.find('/') == std::string_view::npos)
    return {{"application/json", {{"schema", ref("schemas", answer)}}}};
  Json all = Json::object();
  for (std::string_view left = answer; !left.empty();) {
    const std::string_view type = left.substr(0, left.find(' '));
    left.remove_prefix(std::min(left.size(), type.size() + 1));
    Json schema = {{"type", "string"}};
    if (!type.starts_with("text/")) schema["format"] = "binary";
    all[std::string(type)] = {{"schema", std::move(schema)}};
  }
  return all;
}

// Returns the `content` object of a request's body. PATCH requests may also send a JSON merge
// patch.
Json request_content(const ApiRoute& route) {
  Json all = content(route.doc.request);
  if (route.method == Method::kPatch && all.contains("application/json"))
    all["application/merge-patch+json"] = all["application/json"];
  return all;
}

// Returns the parameters of a route: first the path parameters, then query and header parameters.
Json parameters(const ApiRoute& route) {
  Json all = Json::array();
  for (std::size_t at = 0; (at = route.path.find('{', at)) != std::string_view::npos; ++at) {
    const std::string_view name = route.path.substr(at + 1, route.path.find('}', at) - at - 1);
    all.push_back(ref("parameters", fmt::format("path.{}", name)));
  }
  for (std::string_view left = route.doc.parameters; !left.empty();) {
    const std::string_view name = left.substr(0, left.find(' '));
    all.push_back(ref("parameters", name));
    left.remove_prefix(std::min(left.size(), name.size() + 1));
  }
  return all;
}

// Returns the responses of a route. Every route has 400, because the HTTP server refuses malformed
// requests. Other problems, such as 429 and 5xx, are under "default".
Json responses(const ApiRoute& route) {
  const RouteDoc& doc = route.doc;
  Json done = {{"description", doc.status == 202   ? "Accepted; the job continues in the background"
                               : doc.status == 101 ? "Switching protocols"
                                                   : "Success"}};
  if (!doc.response.empty()) done["content"] = content(doc.response);
  if (doc.may_be_gzip) {
    done["headers"] = {{"Content-Encoding", ref("headers", "ContentEncoding")},
                       {"Vary", ref("headers", "Vary")}};
  }
  const Json problem = ref("responses", "Problem");
  Json all = {{std::to_string(doc.status), done}, {"400", problem}};
  if (route.role != Role::kNone) all.update({{"401", problem}, {"403", problem}});
  if (route.path.find('{') != std::string_view::npos) all["404"] = problem;
  all["default"] = problem;
  return all;
}

// Returns the security requirements of a route. If the route is public, the token is optional; with
// a token, the route also shows drafts.
Json security(Role role) {
  const Json token = {{"token", Json::array()}};
  if (role == Role::kNone) return Json::array({Json::object(), token});
  return Json::array({token});
}

Json operation(const ApiRoute& route) {
  const std::string_view noun = route.path.substr(kPrefix.size());
  const RouteDoc& doc = route.doc;
  Json json = {{"operationId", doc.id},
               {"summary", doc.summary},
               {"tags", Json::array({noun.substr(0, noun.find_first_of("/."))})}};
  if (const Json all = parameters(route); !all.empty()) json["parameters"] = all;
  if (!doc.request.empty()) {
    json["requestBody"] = {{"required", doc.request != "Nothing"},
                           {"content", request_content(route)}};
  }
  json["responses"] = responses(route);
  json["security"] = security(route.role);
  if (route.role != Role::kNone) json["x-role"] = name_of(route.role);
  return json;
}

Json components() {
  Json all = Json::object();
  for (const ApiNoun* noun : public_nouns()) {
    if (noun->components.empty()) continue;
    const Json of_noun = Json::parse(noun->components);
    for (const auto& [kind, entries] : of_noun.items())
      all[kind].update(entries);
  }
  return all;
}

Json tags() {
  std::map<std::string_view, std::string_view> by_name;
  for (const ApiNoun* noun : public_nouns()) {
    for (const ApiTag& tag : noun->tags)
      by_name.emplace(tag.name, tag.description);
  }
  Json all = Json::array();
  for (const auto& [name, description] : by_name)
    all.push_back({{"name", name}, {"description", description}});
  return all;
}

std::string openapi_json() {
  Json json = {{"openapi", "3.1.0"},
               {"info",
                {{"title", "Vitrine"},
                 {"version", VITRINE_VERSION},
                 {"description", kAbout},
                 {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
               {"servers", Json::array({{{"url", "/"}}})},
               {"tags", tags()},
               {"paths", Json::object()}};
  for (const ApiRoute& route : public_routes()) {
    if (route.doc.id.empty()) continue;
    json["paths"][std::string(route.path)][std::string(name_of(route.method))] = operation(route);
  }
  json["components"] = components();
  return json.dump();
}

}  // namespace

Response show_openapi(const Request& request, Services&) {
  static const auto document = make_document(openapi_json());
  return kept_json(request.header, document);
}

static constexpr std::string_view kOpenapiComponents = R"json({
"schemas": {
  "OpenapiDocument": {"type": "object", "required": ["openapi", "info", "paths"]}
}
})json";

static constexpr ApiRoute kOpenapiRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/openapi.json",
     .handler = show_openapi,
     .executor = Executor::kInline,
     .doc = {.id = "getOpenapi",
             .summary = "Returns this document.",
             .response = "OpenapiDocument",
             .may_be_gzip = true}},
};

static constexpr ApiTag kOpenapiTags[] = {{.name = "openapi", .description = "This document."}};

const ApiNoun kOpenapi = {
    .routes = kOpenapiRoutes, .components = kOpenapiComponents, .tags = kOpenapiTags};

}  // namespace vitrine::server
