// SPDX-License-Identifier: Apache-2.0
#include "server/api/routes.h"

#include <array>

namespace vitrine::server {
namespace {

// All resources of the API, in the order in which the OpenAPI document lists them. The router
// matches paths in the same order.
constexpr std::array kNouns = {&kCommon,   &kChunks,       &kModels,      &kStreams,     &kExports,
                               &kTileset,  &kPosters,      &kIiif,        &kRecords,     &kOai,
                               &kOembed,   &kOpenapi,      &kModelOrders, &kAnnotations, &kVisits,
                               &kScanners, &kCalibrations, &kScans,       &kJobs,        &kUploads,
                               &kTokens,   &kPages};

}  // namespace

std::span<const ApiNoun* const> public_nouns() {
  return kNouns;
}

std::span<const ApiRoute> public_routes() {
  static const std::vector<ApiRoute> all = [] {
    std::vector<ApiRoute> routes;
    for (const ApiNoun* noun : kNouns)
      routes.insert(routes.end(), noun->routes.begin(), noun->routes.end());
    return routes;
  }();
  return all;
}

// The schemas and parameters of the OpenAPI document that several resources use.
static constexpr std::string_view kCommonComponents = R"json({
"securitySchemes": {
  "token": {"type": "http", "scheme": "bearer", "description": "`vitrine token create` creates a token."}
},
"responses": {
  "Problem": {"description": "The fault, and the parameters that cause it",
    "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}
},
"headers": {
  "ContentEncoding": {"description": "Present if the body is compressed", "schema": {"const": "gzip"}},
  "Vary": {"description": "The request fields that choose the representation, such as Accept-Encoding", "schema": {"type": "string"}}
},
"parameters": {
  "path.id": {"name": "id", "in": "path", "required": true, "schema": {"$ref": "#/components/schemas/Id"}},
  "path.name": {"name": "name", "in": "path", "required": true, "description": "A scanner's name",
    "schema": {"type": "string", "pattern": "^[a-z0-9-]{1,32}$"}},
  "path.sha256": {"name": "sha256", "in": "path", "required": true, "schema": {"$ref": "#/components/schemas/Sha256"}},
  "limit": {"name": "limit", "in": "query", "description": "The largest number of entries on a page",
    "schema": {"type": "integer", "minimum": 1, "maximum": 200, "default": 50}},
  "cursor": {"name": "cursor", "in": "query", "description": "The value of `next` on the previous page",
    "schema": {"$ref": "#/components/schemas/Id"}},
  "idempotencyKey": {"name": "Idempotency-Key", "in": "header",
    "description": "A request repeated with the same key within 30 days does not start a second job",
    "schema": {"type": "string", "minLength": 1, "maxLength": 200}}
},
"schemas": {
  "Id": {"type": "string", "pattern": "^[0-7][0-9a-hjkmnp-tv-z]{25}$"},
  "Sha256": {"type": "string", "pattern": "^[0-9a-f]{64}$"},
  "Time": {"type": "string", "format": "date-time"},
  "Next": {"description": "The cursor of the next page; null on the last page", "anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}]},
  "IdOrNull": {"anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}]},
  "Vector": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
  "Nothing": {"type": "object", "maxProperties": 0},
  "Problem": {"type": "object", "required": ["type", "title", "status", "request_id"], "properties": {
    "type": {"type": "string"}, "title": {"type": "string"}, "status": {"type": "integer"},
    "request_id": {"type": "string", "description": "The server's log names the request by the same ID"}, "detail": {"type": "string"},
    "errors": {"type": "array", "items": {"type": "object", "required": ["parameter", "detail"], "properties": {
      "parameter": {"type": "string"}, "detail": {"type": "string", "description": "The expected value"}}}}}},
  "Webhook": {"type": "string", "description": "A URL to which the server posts the job when it ends. The setting webhook-hosts must list its host"}
}
})json";

const ApiNoun kCommon = {.routes = {}, .components = kCommonComponents};

}  // namespace vitrine::server
