// SPDX-License-Identifier: Apache-2.0
// The OpenAPI 3.1 document of /api/v1, made of the table of routes and what route_docs() says.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "server/auth/role.h"
#include "server/http/handlers.h"
#include "server/http/route_docs.h"
#include "server/http/routes.h"
#include "server/http/services.h"

namespace vitrine {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPrefix = "/api/v1/";

constexpr std::string_view kAbout =
    "Models are progressive meshes: a head that is shown at once, and immutable chunks that refine "
    "it. Everybody may read what is published; the rest needs a token (`Authorization: Bearer "
    "TOKEN`), and `x-role` says of which role. HEAD is answered wherever GET is. Reads have strong "
    "ETags and honour If-None-Match, Range (one range) and If-Range, but for what changes by "
    "itself: scanners, scans and jobs. Faults are RFC 9457 problems. Bodies are JSON of at most "
    "64 KiB.";

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
    case Method::kOptions:
      break;
  }
  return "";
}

Json ref(std::string_view kind, std::string_view name) {
  return {{"$ref", fmt::format("#/components/{}/{}", kind, name)}};
}

// {"application/json": {"schema": ...}} of a schema's name or a media type.
Json content(std::string_view answer) {
  if (answer.find('/') == std::string_view::npos)
    return {{"application/json", {{"schema", ref("schemas", answer)}}}};
  return {{std::string(answer), Json::object()}};
}

// Of the path first, then of the query.
Json parameters(const Route& route, const RouteDoc& doc) {
  Json all = Json::array();
  for (std::size_t at = 0; (at = route.path.find('{', at)) != std::string_view::npos; ++at) {
    const std::string_view name = route.path.substr(at + 1, route.path.find('}', at) - at - 1);
    all.push_back(ref("parameters", fmt::format("path.{}", name)));
  }
  for (std::string_view left = doc.query; !left.empty();) {
    const std::string_view name = left.substr(0, left.find(' '));
    all.push_back(ref("parameters", name));
    left.remove_prefix(std::min(left.size(), name.size() + 1));
  }
  return all;
}

Json responses(const RouteDoc& doc) {
  Json done = {{"description", doc.status == 202   ? "Accepted: it goes on by itself"
                               : doc.status == 101 ? "Switching protocols"
                                                   : "Done"}};
  if (!doc.answer.empty()) done["content"] = content(doc.answer);
  return {{std::to_string(doc.status), done}, {"default", ref("responses", "Problem")}};
}

// Those of a route for everybody may send one: it shows drafts.
Json security(Role role) {
  const Json token = {{"token", Json::array()}};
  if (role == Role::kNone) return Json::array({Json::object(), token});
  return Json::array({token});
}

Json operation(const Route& route, const RouteDoc& doc) {
  const std::string_view noun = route.path.substr(kPrefix.size());
  Json json = {{"operationId", doc.id},
               {"summary", doc.summary},
               {"tags", Json::array({noun.substr(0, noun.find_first_of("/."))})}};
  if (const Json all = parameters(route, doc); !all.empty()) json["parameters"] = all;
  if (!doc.body.empty()) {
    json["requestBody"] = {{"required", doc.body != "Nothing"}, {"content", content(doc.body)}};
  }
  json["responses"] = responses(doc);
  json["security"] = security(route.role);
  if (route.role != Role::kNone) json["x-role"] = name_of(route.role);
  return json;
}

std::string make_document() {
  Json json = {{"openapi", "3.1.0"},
               {"info",
                {{"title", "Vitrine"},
                 {"version", VITRINE_VERSION},
                 {"description", kAbout},
                 {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
               {"servers", Json::array({{{"url", "/"}}})},
               {"paths", Json::object()}};
  for (const Route& route : public_routes()) {
    const RouteDoc* doc = find_doc(route.handler);
    if (!route.path.starts_with(kPrefix) || doc == nullptr) continue;
    json["paths"][std::string(route.path)][std::string(name_of(route.method))] =
        operation(route, *doc);
  }
  json["components"] = Json::parse(api_components());
  return json.dump();
}

}  // namespace

Response show_openapi(const Request&, Services&) {
  static const Response document = revalidated("application/json", make_document());
  return document;
}

}  // namespace vitrine
