// SPDX-License-Identifier: Apache-2.0
#include "server/http/route_docs.h"

namespace vitrine {
namespace {

constexpr std::string_view kComponents = R"json({
"securitySchemes": {
  "token": {"type": "http", "scheme": "bearer", "description": "`vitrine token create` makes one."}
},
"responses": {
  "Problem": {"description": "What is wrong, and where",
    "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}
},
"parameters": {
  "path.id": {"name": "id", "in": "path", "required": true, "schema": {"$ref": "#/components/schemas/Id"}},
  "path.name": {"name": "name", "in": "path", "required": true, "description": "A scanner's name",
    "schema": {"type": "string", "pattern": "^[a-z0-9-]{1,32}$"}},
  "path.number": {"name": "number", "in": "path", "required": true,
    "schema": {"type": "integer", "minimum": 1, "maximum": 999999}},
  "path.sha256": {"name": "sha256", "in": "path", "required": true, "schema": {"$ref": "#/components/schemas/Sha256"}},
  "path.format": {"name": "format", "in": "path", "required": true,
    "schema": {"enum": ["glb", "ply", "obj", "stl", "drc", "wrl"]}},
  "q": {"name": "q", "in": "query", "description": "Words that all occur in title or creator",
    "schema": {"type": "string", "maxLength": 200}},
  "limit": {"name": "limit", "in": "query", "description": "Of one page",
    "schema": {"type": "integer", "minimum": 1, "maximum": 200, "default": 50}},
  "cursor": {"name": "cursor", "in": "query", "description": "The `next` of the page before",
    "schema": {"$ref": "#/components/schemas/Id"}},
  "drafts": {"name": "drafts", "in": "query", "description": "Lists drafts, too; needs a token",
    "schema": {"type": "boolean", "default": false}},
  "triangles": {"name": "triangles", "in": "query",
    "description": "The finest state of at most so many. One of triangles, error, bytes, level, kbps with seconds",
    "schema": {"type": "integer", "minimum": 0}},
  "error": {"name": "error", "in": "query", "description": "The coarsest level whose error is at most this, in the model's unit",
    "schema": {"type": "number", "minimum": 0}},
  "bytes": {"name": "bytes", "in": "query", "description": "The finest state that takes at most so many of the .pmesh",
    "schema": {"type": "integer", "minimum": 0}},
  "level": {"name": "level", "in": "query", "description": "`lowest`, `highest`, or a number from 0",
    "schema": {"type": ["string", "integer"]}},
  "kbps": {"name": "kbps", "in": "query", "description": "Kilobits a second of the line; with seconds",
    "schema": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e9}},
  "seconds": {"name": "seconds", "in": "query", "description": "How long to wait; with kbps",
    "schema": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e9}},
  "saveData": {"name": "Save-Data", "in": "header",
    "description": "`on`, where the request asks for no level: the finest state of at most 1,000,000 bytes of the .pmesh",
    "schema": {"type": "string"}},
  "width": {"name": "width", "in": "query", "description": "Pixels of a side",
    "schema": {"enum": [240, 480, 960], "default": 480}},
  "url": {"name": "url", "in": "query", "required": true, "description": "The page of a model of this server",
    "schema": {"type": "string", "format": "uri"}},
  "maxwidth": {"name": "maxwidth", "in": "query", "schema": {"type": "integer", "minimum": 1}},
  "maxheight": {"name": "maxheight", "in": "query", "schema": {"type": "integer", "minimum": 1}},
  "format": {"name": "format", "in": "query", "schema": {"enum": ["json"], "default": "json"}},
  "from": {"name": "from", "in": "query", "description": "The number of the first point",
    "schema": {"type": "integer", "minimum": 0, "default": 0}},
  "idempotencyKey": {"name": "Idempotency-Key", "in": "header",
    "description": "Sent again under the same key, for 30 days, a request does not begin anything twice",
    "schema": {"type": "string", "minLength": 1, "maxLength": 200}},
  "ifMatch": {"name": "If-Match", "in": "header", "description": "The ETag of what was read; 412 where the model has changed since",
    "schema": {"type": "string"}},
  "tusResumable": {"name": "Tus-Resumable", "in": "header", "required": true, "schema": {"const": "1.0.0"}},
  "uploadLength": {"name": "Upload-Length", "in": "header", "required": true, "description": "Bytes of the whole file",
    "schema": {"type": "integer", "minimum": 0}},
  "uploadMetadata": {"name": "Upload-Metadata", "in": "header", "description": "Names and base64 of their values; kept, and shown to whoever sent it",
    "schema": {"type": "string"}},
  "uploadOffset": {"name": "Upload-Offset", "in": "header", "required": true, "description": "Where the piece goes: what has come already; else 409",
    "schema": {"type": "integer", "minimum": 0}}
},
"schemas": {
  "Id": {"type": "string", "pattern": "^[0-7][0-9a-hjkmnp-tv-z]{25}$"},
  "Sha256": {"type": "string", "pattern": "^[0-9a-f]{64}$"},
  "Time": {"type": "string", "format": "date-time"},
  "Next": {"description": "The cursor of the next page; null: this is the last", "anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}]},
  "IdOrNull": {"anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}]},
  "Vector": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
  "Nothing": {"type": "object", "maxProperties": 0},
  "Problem": {"type": "object", "required": ["type", "title", "status", "request_id"], "properties": {
    "type": {"type": "string"}, "title": {"type": "string"}, "status": {"type": "integer"},
    "request_id": {"type": "string", "description": "The log has the same"}, "detail": {"type": "string"},
    "errors": {"type": "array", "items": {"type": "object", "required": ["parameter", "detail"], "properties": {
      "parameter": {"type": "string"}, "detail": {"type": "string", "description": "What is expected"}}}}}},
  "Model": {"type": "object",
    "required": ["id", "state", "title", "creator", "rights", "licence", "unit", "created", "vertices", "faces", "bytes", "head_bytes", "links"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "state": {"enum": ["published", "draft"]},
      "title": {"type": "string"}, "creator": {"type": "string"}, "rights": {"type": "string", "description": "A statement for people"},
      "licence": {"type": "string", "description": "An SPDX identifier or an address"},
      "unit": {"type": "string", "description": "Of the coordinates; empty: unknown"},
      "accuracy": {"type": ["number", "null"], "description": "Of the scan, in that unit"},
      "public_max_level": {"type": ["integer", "null"], "description": "The finest that visitors get; null: all"}, "created": {"$ref": "#/components/schemas/Time"},
      "vertices": {"type": "integer"}, "faces": {"type": "integer"}, "bytes": {"type": "integer"},
      "head_bytes": {"type": "integer"}, "links": {"type": "object", "additionalProperties": {"type": "string"}}}},
  "ModelPage": {"type": "object", "required": ["models", "next"], "properties": {
    "models": {"type": "array", "items": {"$ref": "#/components/schemas/Model"}}, "next": {"$ref": "#/components/schemas/Next"}}},
  "Manifest": {"type": "object",
    "required": ["id", "sha256", "bytes", "head_bytes", "unit", "placement", "coloured", "lattice", "bounding_box", "levels", "regions", "adjacency", "base", "chunks"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "sha256": {"$ref": "#/components/schemas/Sha256"},
      "bytes": {"type": "integer"}, "head_bytes": {"type": "integer"}, "unit": {"type": "string"},
      "placement": {"enum": ["midpoint", "pyramid"]}, "coloured": {"type": "boolean"}, "boundary_loops": {"type": "integer"},
      "lattice": {"type": "object", "required": ["origin", "step", "bits"], "properties": {
        "origin": {"$ref": "#/components/schemas/Vector"}, "step": {"type": "number"}, "bits": {"type": "integer"}}},
      "bounding_box": {"type": "object", "required": ["min", "max"], "properties": {
        "min": {"$ref": "#/components/schemas/Vector"}, "max": {"$ref": "#/components/schemas/Vector"}}},
      "levels": {"type": "array", "items": {"type": "object",
        "required": ["vertices", "faces", "cumulative_bytes", "max_error", "rms_error"], "properties": {
        "vertices": {"type": "integer"}, "faces": {"type": "integer"}, "cumulative_bytes": {"type": "integer"},
        "max_error": {"type": "number", "description": "A bound, in model units"}, "rms_error": {"type": "number"},
        "display_filter": {"type": "number"}}}},
      "regions": {"type": "integer"}, "adjacency": {"type": "array"},
      "base": {"type": "object", "required": ["offset", "length", "sha256"], "properties": {
        "offset": {"type": "integer"}, "length": {"type": "integer"}, "sha256": {"$ref": "#/components/schemas/Sha256"}}},
      "chunks": {"type": "array", "items": {"type": "object", "required": ["level", "region", "offset", "length", "max_error", "sha256"], "properties": {
        "level": {"type": "integer"}, "region": {"type": "integer"}, "leaves": {"type": "integer"}, "offset": {"type": "integer"},
        "length": {"type": "integer"}, "splits": {"type": "integer"}, "newborn": {"type": "integer"}, "max_error": {"type": "number"},
        "sha256": {"$ref": "#/components/schemas/Sha256"}}}},
      "expect": {"$ref": "#/components/schemas/Expectation"}}},
  "Expectation": {"type": "object", "description": "What comes of the request's wish, or of Save-Data",
    "required": ["level", "triangles", "bytes", "error", "seconds"], "properties": {
      "level": {"type": "integer", "description": "The finest that is complete"}, "triangles": {"type": "integer"},
      "bytes": {"type": "integer", "description": "Of the .pmesh"}, "error": {"type": "number", "description": "A bound, in model units"},
      "seconds": {"type": ["number", "null"], "description": "On a line of kbps; null where the request names none"}}},
  "IiifManifest": {"type": "object", "required": ["@context", "id", "type", "label", "items"], "properties": {
    "@context": {"const": "http://iiif.io/api/presentation/3/context.json"}, "id": {"type": "string"}, "type": {"const": "Manifest"},
    "label": {"type": "object"}, "items": {"type": "array"}}},
  "Oembed": {"type": "object", "required": ["version", "type", "html", "width", "height"], "properties": {
    "version": {"const": "1.0"}, "type": {"const": "rich"}, "title": {"type": "string"}, "author_name": {"type": "string"},
    "provider_name": {"type": "string"}, "provider_url": {"type": "string"}, "html": {"type": "string"},
    "width": {"type": "integer"}, "height": {"type": "integer"}, "thumbnail_url": {"type": "string"},
    "thumbnail_width": {"type": "integer"}, "thumbnail_height": {"type": "integer"}}},
  "OpenapiDocument": {"type": "object", "required": ["openapi", "info", "paths"]},
  "Scanner": {"type": "object", "required": ["id", "name", "state", "camera", "board", "calibration", "scan", "problem"], "properties": {
    "id": {"type": "string"}, "name": {"type": "string"}, "state": {"enum": ["idle", "busy", "unreachable"]},
    "camera": {"type": ["object", "null"], "properties": {"vendor": {"type": "string"}, "model": {"type": "string"}, "serial": {"type": "string"}}},
    "board": {"type": ["object", "null"], "properties": {"dialect": {"type": "string"}, "firmware": {"type": "string"}}},
    "calibration": {"type": ["integer", "null"]}, "scan": {"$ref": "#/components/schemas/IdOrNull"},
    "problem": {"type": ["string", "null"], "description": "What keeps it from working, and what to do"}}},
  "ScannerList": {"type": "object", "required": ["scanners"], "properties": {
    "scanners": {"type": "array", "items": {"$ref": "#/components/schemas/Scanner"}}}},
  "Jog": {"type": "object", "required": ["degrees"], "additionalProperties": false, "properties": {
    "degrees": {"type": "number", "minimum": -36000, "maximum": 36000}}},
  "LaserSwitch": {"type": "object", "required": ["on"], "additionalProperties": false, "properties": {"on": {"type": "boolean"}}},
  "CalibrationOrder": {"type": "object", "additionalProperties": false, "properties": {
    "poses": {"type": "integer", "minimum": 3, "maximum": 200, "default": 20}, "webhook": {"$ref": "#/components/schemas/Webhook"}}},
  "CalibrationList": {"type": "object", "required": ["calibrations", "damaged"], "properties": {
    "calibrations": {"type": "array", "items": {"type": "object", "required": ["number", "rms"], "properties": {
      "number": {"type": "integer"}, "created": {"type": "string"}, "camera": {"type": "string"}, "region": {"type": "object"},
      "rms": {"type": "number", "description": "mm, over held-out poses"}, "p95": {"type": "number"}, "max": {"type": "number"}, "coverage": {"type": "number"}}}},
    "damaged": {"type": "array", "items": {"type": "object", "properties": {"number": {"type": "integer"}, "problem": {"type": "string"}}}}}},
  "CalibrationReport": {"type": "object", "required": ["number", "camera", "residuals_mm"]},
  "Metadata": {"unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/MetadataTexts"}]},
  "MetadataTexts": {"type": "object", "properties": {
    "title": {"type": "string"}, "creator": {"type": "string"}, "rights": {"type": "string"}, "licence": {"type": "string"},
    "contributor": {"type": "string"}, "coverage": {"type": "string"}, "date": {"type": "string"}, "description": {"type": "string"},
    "identifier": {"type": "string"}, "language": {"type": "string"}, "publisher": {"type": "string"}, "relation": {"type": "string"},
    "source": {"type": "string"}, "subject": {"type": "string"}, "type": {"type": "string"}}},
  "Webhook": {"type": "string", "description": "A URL that is posted the job when it ends; its host has to be among the setting webhook-hosts"},
  "ModelOrder": {"type": "object", "required": ["upload"], "additionalProperties": false, "properties": {
    "upload": {"$ref": "#/components/schemas/Id"}, "metadata": {"$ref": "#/components/schemas/Metadata"},
    "publish": {"type": "boolean", "default": false, "description": "Else it ends as a draft"},
    "replace": {"anyOf": [{"$ref": "#/components/schemas/Id"}, {"type": "null"}], "description": "The model whose place it takes"},
    "webhook": {"$ref": "#/components/schemas/Webhook"},
    "bits": {"anyOf": [{"const": "auto"}, {"const": 0}, {"type": "integer", "minimum": 10, "maximum": 16}], "default": "auto"},
    "placement": {"enum": ["midpoint", "pyramid"]}, "unit": {"enum": ["mm", "cm", "m", "in"], "description": "Where the file states none"},
    "up": {"enum": ["y", "z"], "default": "y"}}},
  "ModelChange": {"type": "object", "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/MetadataTexts"}],
    "description": "What is not said stays", "properties": {
    "metadata": {"$ref": "#/components/schemas/Metadata"}, "unit": {"enum": ["", "mm", "cm", "m", "in"]},
    "accuracy": {"type": ["number", "null"], "minimum": 0, "description": "Of the scan, in the model's unit"},
    "public_max_level": {"type": ["integer", "null"], "minimum": 0, "maximum": 255, "description": "The finest that visitors get; null: all"}}},
  "Upload": {"type": "object", "required": ["id", "length", "offset", "expires"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "length": {"type": "integer"}, "offset": {"type": "integer"},
    "expires": {"$ref": "#/components/schemas/Time"}}},
  "RoleName": {"enum": ["viewer", "operator", "admin"]},
  "TokenOrder": {"type": "object", "required": ["role"], "additionalProperties": false, "properties": {
    "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string", "description": "For people"}}},
  "TokenPage": {"type": "object", "required": ["tokens", "next"], "properties": {"next": {"$ref": "#/components/schemas/Next"}, "tokens": {"type": "array", "items": {"type": "object",
    "required": ["id", "role", "label", "created"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string"},
    "created": {"$ref": "#/components/schemas/Time"}}}}}},
  "NewToken": {"type": "object", "required": ["id", "role", "label", "token"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string"},
    "token": {"type": "string", "description": "Shown this once"}}},
  "Processing": {"type": "object", "properties": {
    "calibration": {"type": "integer", "minimum": 1, "description": "The newest where nothing is said"},
    "stripe": {"enum": ["derivative-of-gaussian", "centre-of-mass", "blais-rioux"]},
    "sampling": {"enum": ["adaptive", "paper", "equidistant"]}, "length": {"enum": [5, 10, 15, 20], "default": 5},
    "largest_angle": {"type": "number", "minimum": 0}, "largest_hole": {"type": "number", "minimum": 0, "description": "mm"},
    "bits": {"anyOf": [{"const": "auto"}, {"const": 0}, {"type": "integer", "minimum": 10, "maximum": 16}], "default": "auto"},
    "placement": {"enum": ["midpoint", "pyramid"]}, "metadata": {"$ref": "#/components/schemas/Metadata"},
    "publish": {"type": "boolean", "default": false, "description": "Else it ends as a draft"}, "webhook": {"$ref": "#/components/schemas/Webhook"}}},
  "ScanOrder": {"required": ["scanner"], "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/Processing"}],
    "type": "object", "properties": {
    "scanner": {"type": "string", "description": "Its name"}, "steps": {"type": "integer", "default": 720},
    "exposure": {"type": "number", "minimum": 1, "description": "Microseconds; the scanner's where nothing is said"},
    "keep_frames": {"type": "boolean", "default": false}}},
  "ReprocessOrder": {"type": "object", "unevaluatedProperties": false, "allOf": [{"$ref": "#/components/schemas/Processing"}],
    "description": "What is not said is as the scan was ordered"},
  "JobStarted": {"type": "object", "required": ["job"], "properties": {"job": {"$ref": "#/components/schemas/Id"}}},
  "ScanStarted": {"type": "object", "required": ["id", "job"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "job": {"$ref": "#/components/schemas/Id"}}},
  "Scan": {"type": "object", "required": ["id", "job", "scanner", "state", "step", "steps", "progress", "eta", "error", "note", "points", "model", "title", "created"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "job": {"$ref": "#/components/schemas/Id"}, "scanner": {"type": "string"},
      "state": {"enum": ["waiting", "scanning", "paused", "meshing", "building", "done", "failed", "cancelled"]},
      "step": {"type": "integer"}, "steps": {"type": "integer"}, "progress": {"type": "number", "minimum": 0, "maximum": 1},
      "eta": {"type": ["number", "null"], "description": "Seconds"}, "error": {"type": ["string", "null"]},
      "note": {"type": ["string", "null"], "description": "What it waits for"}, "calibration": {"type": ["integer", "null"]},
      "points": {"type": "integer"}, "rows": {"type": ["object", "null"]}, "model": {"$ref": "#/components/schemas/IdOrNull"},
      "title": {"type": "string"}, "created": {"$ref": "#/components/schemas/Time"}}},
  "ScanPage": {"type": "object", "required": ["scans", "next"], "properties": {
    "scans": {"type": "array", "items": {"$ref": "#/components/schemas/Scan"}}, "next": {"$ref": "#/components/schemas/Next"}}},
  "Profile": {"type": "array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
    "description": "rho and z in mm of each point"},
  "Job": {"type": "object", "required": ["id", "kind", "state", "stage", "progress", "eta", "error", "scan", "model", "created", "ended"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "kind": {"type": "string"},
      "state": {"enum": ["queued", "running", "paused", "done", "failed", "cancelled"]}, "stage": {"type": ["string", "null"]},
      "progress": {"type": "number", "minimum": 0, "maximum": 1}, "eta": {"type": ["number", "null"], "description": "Seconds"},
      "error": {"type": ["string", "null"]}, "note": {"type": ["string", "null"]}, "scanner": {"type": "string"},
      "scan": {"$ref": "#/components/schemas/IdOrNull"}, "model": {"$ref": "#/components/schemas/IdOrNull"},
      "created": {"$ref": "#/components/schemas/Time"}, "ended": {"anyOf": [{"$ref": "#/components/schemas/Time"}, {"type": "null"}]}}},
  "JobPage": {"type": "object", "required": ["jobs", "next"], "properties": {
    "jobs": {"type": "array", "items": {"$ref": "#/components/schemas/Job"}}, "next": {"$ref": "#/components/schemas/Next"}}}
}
})json";

}  // namespace

std::string_view api_components() {
  return kComponents;
}

}  // namespace vitrine
