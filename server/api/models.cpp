// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "server/api/detail_request.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/model_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/messages/content_coding.h"
#include "server/messages/query.h"

namespace vitrine::server {
namespace {

using Faults = std::vector<ParameterFault>;

// Returns a response with a range of the model's file. The entity tag changes with the file.
// `suffix` distinguishes the tags of different responses from one file.
Response stored(const std::shared_ptr<const PublishedModel>& model, ByteRange range,
                std::string_view suffix) {
  Response response;
  response.type = "application/octet-stream";
  response.caching = Caching::kRevalidate;
  response.etag = stored_tag(*model, model->record().file, suffix);
  response.body = stored_body(model, range);
  return response;
}

// Returns the head of the model's file. If the model has a presentation or notes, the field
// Vitrine-Presentation contains the presentation and the number of notes, so that viewers need no
// second request for them.
Response head_of(const std::shared_ptr<const PublishedModel>& model) {
  const Presentation& presentation = model->record().presentation;
  const std::uint64_t notes = model->record().notes;
  std::string text = client_text(presentation, notes);
  if (text.empty()) return stored(model, model->head(), "-head");
  Response response =
      stored(model, model->head(), fmt::format("-head-{}-{}", key_of(presentation), notes));
  response.fields = {{"Vitrine-Presentation", std::move(text)}};
  return response;
}

// Reads the filters of a search: words, facets and whether to include drafts.
ModelQuery read_search(const Query& query, Faults& faults) {
  constexpr std::size_t kMaxText = 200;
  ModelQuery out;
  if (const auto text = query.get("q")) {
    out.text = *text;
    if (text->size() > kMaxText) faults.push_back({"q", fmt::format("at most {} bytes", kMaxText)});
  }
  for (const std::string_view name : kFacetNames) {
    if (const auto value = query.get(name)) out.facets[std::string(name)] = *value;
  }
  if (const auto drafts = query.get("drafts")) {
    out.includes_drafts = *drafts == "true";
    if (!out.includes_drafts && *drafts != "false") faults.push_back({"drafts", "true or false"});
  }
  return out;
}

// Reads the filters, the sort order and the page of a search.
ModelQuery read_query(const Query& query, Faults& faults) {
  constexpr std::string_view kOrders[] = {"newest", "oldest", "title", "creator"};
  ModelQuery out = read_search(query, faults);
  if (const auto order = query.get("sort")) {
    const auto* const found = std::ranges::find(kOrders, *order);
    if (found == std::end(kOrders))
      faults.push_back({"sort", fmt::format("one of {}", fmt::join(kOrders, ", "))});
    else
      out.ordering = static_cast<ModelOrdering>(found - std::begin(kOrders));
  }
  if (const auto page = read_page<ModelId>(query)) {
    out.after = page->after;
    out.limit = page->limit;
  } else {
    faults.insert(faults.end(), page.error().begin(), page.error().end());
  }
  return out;
}

// Sets the state of the model and returns the model as JSON. If the model already has that state,
// changes nothing.
Response in_state(ModelState state, const Request& request, Services& services) {
  auto model = services.catalogue.find(id_in<ModelId>(request));
  if (!model) return internal_error(model.error(), request, services);
  if (!*model) return problem(404, "there is no such model", request.id);
  if ((*model)->state != state) {
    const auto done = services.catalogue.set_state((*model)->id, state);
    if (!done) return refused(done.error(), request, services);
    services.models.refresh();
    (*model)->state = state;
    if (state == ModelState::kPublished && services.order_posters)
      services.order_posters((*model)->id);
  }
  Response response;
  response.type = "application/json";
  response.body = model_json(**model, view_for(request, services));
  return response;
}

Response manifest_response(const Request& request, std::shared_ptr<const Document> manifest) {
  Response response = kept_json(request.header, std::move(manifest));
  add_vary(response, "Save-Data");
  return response;
}

}  // namespace

static Response list_models(const Request& request, Services& services) {
  constexpr std::string_view kKnown[] = {"q",        "subject", "creator",    "period",
                                         "material", "licence", "collection", "sort",
                                         "limit",    "cursor",  "drafts"};
  const auto query = read_query(request, kKnown);
  if (!query) return query.error();
  Faults faults;
  const ModelQuery wanted = read_query(*query, faults);
  if (!faults.empty()) return problem(400, "a parameter is out of range", request.id, faults);
  if (wanted.includes_drafts && !request.caller) return token_needed(request);
  const auto page = services.catalogue.search(wanted);
  if (!page) return internal_error(page.error(), request, services);
  Response response =
      revalidated("application/json", model_page_json(*page, view_for(request, services)));
  if (page->next) link_next(page->next->to_string(), request, response);
  if (request.caller) return for_caller(std::move(response));
  return response;
}

static Response list_facets(const Request& request, Services& services) {
  constexpr std::string_view kKnown[] = {"q",        "subject", "creator",    "period",
                                         "material", "licence", "collection", "drafts"};
  const auto query = read_query(request, kKnown);
  if (!query) return query.error();
  Faults faults;
  const ModelQuery wanted = read_search(*query, faults);
  if (!faults.empty()) return problem(400, "a parameter is out of range", request.id, faults);
  if (wanted.includes_drafts && !request.caller) return token_needed(request);
  const auto facets = services.catalogue.facets(wanted);
  if (!facets) return internal_error(facets.error(), request, services);
  Response response = revalidated("application/json", facets_json(*facets));
  return request.caller ? for_caller(std::move(response)) : response;
}

static Response show_model(const Request& request, Services& services) {
  const ModelView view = view_for(request, services);
  return with_model(request, services, [&](const auto& model) {
    Response response =
        revalidated("application/json", model_json(model->record(), model->manifest(), view));
    response.etag = model_tag(model->record(), view);
    return view.has_token ? for_caller(std::move(response)) : response;
  });
}

static Response show_manifest(const Request& request, Services& services) {
  const auto query = Query::parse(request.query);
  if (!query) return problem(400, "the query is malformed", request.id);
  return with_model(request, services, [&](const auto& model) {
    const auto detail = read_detail_request(*query, request.header, model->manifest());
    if (!detail) return problem(400, "a parameter is out of range", request.id, {detail.error()});
    const bool asked = detail->is_stated || saves_data(request.header);
    std::string json = manifest_json(*model, asked ? std::optional(*detail) : std::nullopt);
    if (asked || request.caller) {
      Response response = revalidated("application/json", std::move(json));
      add_vary(response, "Save-Data");
      return response;
    }
    const auto document = make_document(std::move(json));
    services.models.keep_manifest(model, document);
    return manifest_response(request, document);
  });
}

static std::optional<Response> show_held_manifest(const Request& request, Services& services) {
  const bool is_plain = request.query.empty() && !saves_data(request.header) &&
                        request.header.count(beast::http::field::authorization) == 0;
  if (!is_plain) return std::nullopt;
  const auto model = cached_visible(id_in<ModelId>(request), false, services.models);
  const auto kept = model ? model->kept_manifest() : nullptr;
  if (!kept) return std::nullopt;
  return manifest_response(request, kept);
}

static Response show_head(const Request& request, Services& services) {
  return with_model(request, services, [](const auto& model) { return head_of(model); });
}

static Response show_file(const Request& request, Services& services) {
  return with_model(request, services,
                    [](const auto& model) { return stored(model, model->whole(), ""); });
}

static Response publish_model(const Request& request, Services& services) {
  return in_state(ModelState::kPublished, request, services);
}

static Response unpublish_model(const Request& request, Services& services) {
  return in_state(ModelState::kDraft, request, services);
}

static constexpr std::string_view kModelsComponents = R"json({
"parameters": {
  "q": {"name": "q", "in": "query", "description": "Words that all begin words of the model's texts, without regard to case and accents",
    "schema": {"type": "string", "maxLength": 200}},
  "subject": {"name": "subject", "in": "query", "description": "A subject that the models must have", "schema": {"type": "string"}},
  "creator": {"name": "creator", "in": "query", "description": "A creator that the models must have", "schema": {"type": "string"}},
  "period": {"name": "period", "in": "query", "description": "A period that the models must have", "schema": {"type": "string"}},
  "material": {"name": "material", "in": "query", "description": "A material that the models must have", "schema": {"type": "string"}},
  "licence": {"name": "licence", "in": "query", "description": "The licence that the models must have", "schema": {"type": "string"}},
  "collection": {"name": "collection", "in": "query", "description": "The collection that the models must belong to", "schema": {"type": "string"}},
  "sort": {"name": "sort", "in": "query", "description": "The order of the models",
    "schema": {"enum": ["newest", "oldest", "title", "creator"], "default": "newest"}},
  "drafts": {"name": "drafts", "in": "query", "description": "Whether to list drafts too; requires a token",
    "schema": {"type": "boolean", "default": false}},
  "triangles": {"name": "triangles", "in": "query",
    "description": "The finest state with at most this many triangles. Give one of triangles, error, bytes, level, kbps with seconds",
    "schema": {"type": "integer", "minimum": 0}},
  "error": {"name": "error", "in": "query", "description": "The coarsest level whose error is at most this, in the coordinates of the file",
    "schema": {"type": "number", "minimum": 0}},
  "bytes": {"name": "bytes", "in": "query", "description": "The finest state that needs at most this many bytes of the .pmesh",
    "schema": {"type": "integer", "minimum": 0}},
  "level": {"name": "level", "in": "query", "description": "`lowest`, `highest`, or a number from 0",
    "schema": {"type": ["string", "integer"]}},
  "kbps": {"name": "kbps", "in": "query", "description": "Bandwidth of the connection in kilobits per second; requires seconds",
    "schema": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e9}},
  "seconds": {"name": "seconds", "in": "query", "description": "Longest acceptable loading time in seconds; requires kbps",
    "schema": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e9}},
  "saveData": {"name": "Save-Data", "in": "header",
    "description": "`on` selects the finest state that needs at most 1,000,000 bytes of the .pmesh, if the request has no detail target",
    "schema": {"type": "string"}}
},
"schemas": {
  "Model": {"type": "object",
    "required": ["id", "state", "title", "creator", "rights", "licence", "unit", "created", "vertices", "faces", "bytes", "head_bytes", "textures", "presentation", "links"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "state": {"enum": ["published", "draft"]},
      "title": {"type": "string"}, "creator": {"type": "string"}, "rights": {"type": "string", "description": "A rights statement in plain text"},
      "licence": {"type": "string", "description": "An SPDX identifier or a URL"},
      "unit": {"type": "string", "description": "Unit of the coordinates; empty if unknown"},
      "accuracy": {"type": ["number", "null"], "description": "Accuracy of the scan in the model's unit"},
      "dimensions": {"oneOf": [{"type": "null"}, {"type": "object", "required": ["width", "height", "depth", "unit"], "properties": {
        "width": {"type": "number"}, "height": {"type": "number"}, "depth": {"type": "number"}, "unit": {"type": "string"}}}],
        "description": "Size of the presented mesh, with the height along y; null if the unit is unknown. Only in the responses of GET and PATCH for a single model"},
      "citation": {"type": "object", "required": ["apa", "chicago", "mla"], "properties": {
        "apa": {"type": "string"}, "chicago": {"type": "string"}, "mla": {"type": "string"}},
        "description": "How to cite the model, in three styles. Only in the responses of GET and PATCH for a single model"},
      "presentation": {"$ref": "#/components/schemas/Presentation"},
      "public_max_level": {"type": ["integer", "null"], "description": "The finest level that visitors can load; null for all levels. A limited model also lacks the pictures of a texture that are not in the head"}, "created": {"$ref": "#/components/schemas/Time"},
      "vertices": {"type": "integer"}, "faces": {"type": "integer"}, "bytes": {"type": "integer"},
      "head_bytes": {"type": "integer"},
      "textures": {"type": "object", "description": "The pictures of the texture; all 0 without a texture", "required": ["count", "largest_side", "bytes"], "properties": {
        "count": {"type": "integer", "description": "Number of kinds of pictures, such as base colours and normals"},
        "largest_side": {"type": "integer", "description": "Largest width and height in pixels"},
        "bytes": {"type": "integer", "description": "Size of all pictures, in all sizes"}}},
      "repairs": {"type": "array", "items": {"type": "string"}, "description": "What the build of the file changed or left out; missing for clients without a token"},
      "links": {"type": "object", "description": "Paths on this server", "required": ["self", "page", "manifest", "head", "file", "stream", "notes", "tours", "poster"], "properties": {
        "self": {"type": "string"}, "page": {"type": "string"}, "manifest": {"type": "string"}, "head": {"type": "string"},
        "file": {"type": "string"}, "stream": {"type": "string"}, "notes": {"type": "string"}, "tours": {"type": "string"}, "poster": {"type": "string"},
        "visits": {"type": "string", "description": "Where viewers report visits; missing if the server does not count them"}}}}},
  "Presentation": {"type": "object", "description": "How the model is presented. Viewers, exports, posters and dimensions obey it",
    "properties": {
      "rotation": {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4, "default": [0, 0, 0, 1],
        "description": "Unit quaternion x, y, z, w that turns the model from the coordinates of its file so that y points up"},
      "scale": {"type": "number", "minimum": 1e-9, "maximum": 1e9, "default": 1, "description": "Factor from the coordinates of the file to the model's unit"},
      "view": {"anyOf": [{"$ref": "#/components/schemas/PresentedView"}, {"type": "null"}], "description": "The first view of viewers; null for the usual one"},
      "poster": {"anyOf": [{"$ref": "#/components/schemas/PresentedView"}, {"type": "null"}], "description": "The view of posters; null for the first view of viewers"},
      "light": {"anyOf": [{"type": "null"}, {"type": "object", "properties": {
        "preset": {"enum": ["studio", "raking", "relief"]},
        "angle": {"type": "number", "minimum": 0, "maximum": 360, "default": 315, "description": "Direction of raking light in degrees, clockwise from the top"}}}],
        "description": "The first light of viewers; null for the usual one"},
      "notes": {"type": "integer", "minimum": 1, "readOnly": true, "description": "Number of notes on the model; missing if there are none. Only in the field Vitrine-Presentation and the stream"}}},
  "PresentedView": {"type": "object", "description": "A view of the presented model", "properties": {
    "azimuth": {"type": "number", "minimum": -360, "maximum": 360, "description": "Degrees around y; 0 is the front (z), 90 the right side (x)"},
    "elevation": {"type": "number", "minimum": -90, "maximum": 90, "description": "Degrees; 90 is above"},
    "zoom": {"type": "number", "minimum": 0.1, "maximum": 100, "default": 1, "description": "1 shows the whole model"},
    "target": {"anyOf": [{"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, {"type": "null"}],
      "description": "The point in the middle of the view, in the unit of the presented model; null for its centre"}}},
  "Facets": {"type": "object", "required": ["models", "facets"], "properties": {
    "models": {"type": "integer", "description": "Number of all models that the search finds"},
    "facets": {"type": "object", "description": "The 30 most frequent values of each facet among these models, the most frequent first",
      "additionalProperties": {"type": "array", "items": {"type": "object", "required": ["value", "models"], "properties": {
        "value": {"type": "string"}, "models": {"type": "integer"}}}}}}},
  "ModelPage": {"type": "object", "required": ["models", "next"], "properties": {
    "models": {"type": "array", "items": {"$ref": "#/components/schemas/Model"}}, "next": {"$ref": "#/components/schemas/Next"}}},
  "Manifest": {"type": "object",
    "required": ["id", "sha256", "bytes", "head_bytes", "unit", "placement", "coloured", "lattice", "bounding_box", "presentation", "levels", "regions", "adjacency", "base", "texture", "originals", "chunks"],
    "properties": {
      "id": {"$ref": "#/components/schemas/Id"}, "sha256": {"$ref": "#/components/schemas/Sha256"},
      "bytes": {"type": "integer"}, "head_bytes": {"type": "integer"}, "unit": {"type": "string"},
      "placement": {"enum": ["midpoint", "pyramid"]}, "coloured": {"type": "boolean"}, "boundary_loops": {"type": "integer"},
      "lattice": {"type": "object", "required": ["origin", "step", "bits"], "properties": {
        "origin": {"$ref": "#/components/schemas/Vector"}, "step": {"type": "number"}, "bits": {"type": "integer"}}},
      "bounding_box": {"type": "object", "required": ["min", "max"], "properties": {
        "min": {"$ref": "#/components/schemas/Vector"}, "max": {"$ref": "#/components/schemas/Vector"}},
        "description": "Bounding box in the coordinates of the file, which the presentation does not change"},
      "presentation": {"$ref": "#/components/schemas/Presentation"},
      "levels": {"type": "array", "items": {"type": "object",
        "required": ["vertices", "faces", "cumulative_bytes", "max_error", "rms_error"], "properties": {
        "vertices": {"type": "integer"}, "faces": {"type": "integer"}, "cumulative_bytes": {"type": "integer"},
        "max_error": {"type": "number", "description": "Upper bound in model units"}, "rms_error": {"type": "number"},
        "display_filter": {"type": "number"}}}},
      "regions": {"type": "integer"}, "adjacency": {"type": "array", "items": {"type": "array", "items": {"type": "integer"}}},
      "base": {"type": "object", "required": ["offset", "length", "sha256"], "properties": {
        "offset": {"type": "integer"}, "length": {"type": "integer"}, "sha256": {"$ref": "#/components/schemas/Sha256"}}},
      "texture": {"oneOf": [{"$ref": "#/components/schemas/Texture"}, {"type": "null"}]},
      "originals": {"oneOf": [{"$ref": "#/components/schemas/Originals"}, {"type": "null"}]},
      "chunks": {"type": "array", "items": {"type": "object", "required": ["level", "region", "offset", "length", "max_error", "sha256"], "properties": {
        "level": {"type": "integer"}, "region": {"type": "integer"}, "leaves": {"type": "integer"}, "offset": {"type": "integer"},
        "length": {"type": "integer"}, "splits": {"type": "integer"}, "newborn": {"type": "integer"}, "max_error": {"type": "number"},
        "sha256": {"$ref": "#/components/schemas/Sha256"}}}},
      "expect": {"$ref": "#/components/schemas/Expectation"}}},
  "Texture": {"type": "object", "description": "The display atlas of a model and its pictures",
    "required": ["side", "alpha_mode", "alpha_cutoff", "double_sided", "unlit", "atlas", "pictures"], "properties": {
      "side": {"type": "integer", "description": "Width and height of all pictures, in units of texture coordinates"},
      "alpha_mode": {"enum": ["opaque", "mask", "blend"]},
      "alpha_cutoff": {"type": "number", "description": "For mask: smaller opacities are invisible"},
      "double_sided": {"type": "boolean"}, "unlit": {"type": "boolean"},
      "atlas": {"type": "object", "description": "The coded texture coordinates of the base mesh", "required": ["offset", "length", "sha256"], "properties": {
        "offset": {"type": "integer"}, "length": {"type": "integer"}, "sha256": {"$ref": "#/components/schemas/Sha256"}}},
      "pictures": {"type": "array", "items": {"type": "object", "description": "A square WebP file",
        "required": ["role", "side", "in_head", "offset", "length", "sha256"], "properties": {
        "role": {"enum": ["base_colour", "normal", "surface", "emission"],
          "description": "surface: occlusion (red), roughness (green) and metallic (blue)"},
        "side": {"type": "integer", "description": "Width and height in pixels"},
        "in_head": {"type": "boolean", "description": "Whether the head contains the picture"},
        "offset": {"type": "integer"}, "length": {"type": "integer"}, "sha256": {"$ref": "#/components/schemas/Sha256"}}}}}},
  "Originals": {"type": "object", "description": "The source's pictures, materials and texture coordinates, to the bit. A model with public_max_level hides them from visitors",
    "required": ["description", "pictures"], "properties": {
      "description": {"$ref": "#/components/schemas/Block"},
      "pictures": {"type": "array", "items": {"$ref": "#/components/schemas/Block"}}}},
  "Block": {"type": "object", "description": "A part of the file, which /chunks/{sha256} serves", "required": ["offset", "length", "sha256"], "properties": {
    "offset": {"type": "integer"}, "length": {"type": "integer"}, "sha256": {"$ref": "#/components/schemas/Sha256"}}},
  "Expectation": {"type": "object", "description": "The expected result of the detail request or of Save-Data",
    "required": ["level", "triangles", "bytes", "error", "seconds"], "properties": {
      "level": {"type": "integer", "description": "The finest complete level"}, "triangles": {"type": "integer"},
      "bytes": {"type": "integer", "description": "Bytes of the .pmesh"}, "error": {"type": "number", "description": "Upper bound in model units"},
      "seconds": {"type": ["number", "null"], "description": "Loading time at kbps; null if the request has no kbps"}}}
}
})json";

static constexpr ApiRoute kModelRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models",
     .handler = list_models,
     .executor = Executor::kWorker,
     .doc = {.id = "listModels",
             .summary = "Lists the published models that match words and facets.",
             .parameters = "q subject creator period material licence collection sort limit cursor "
                           "drafts",
             .response = "ModelPage",
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/facets",
     .handler = list_facets,
     .executor = Executor::kWorker,
     .doc = {.id = "listFacets",
             .summary = "Counts the subjects, creators, periods, materials, licences and "
                        "collections of the models that match words and facets.",
             .parameters = "q subject creator period material licence collection drafts",
             .response = "Facets",
             .may_be_gzip = true}},
    // The routes below need no token, but for a caller with a token the handlers also show drafts.
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}",
     .handler = show_model,
     .executor = Executor::kWorker,
     .doc = {.id = "getModel",
             .summary = "Returns a model's metadata, sizes and links.",
             .response = "Model",
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/manifest",
     .handler = show_manifest,
     .executor = Executor::kWorker,
     .quick = show_held_manifest,
     .doc = {.id = "getManifest",
             .summary = "Lists a model's levels, regions, chunks, sizes and errors. With a "
                        "detail request, also the expected result.",
             .parameters = "triangles error bytes level kbps seconds saveData",
             .response = "Manifest",
             .may_be_gzip = true}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/head",
     .handler = show_head,
     .executor = Executor::kWorker,
     .doc = {.id = "getHead",
             .summary =
                 "Returns the header and the base mesh, and the first picture of a texture. They "
                 "suffice for the first view. If the model has notes, or is presented otherwise "
                 "than its file, the field Vitrine-Presentation of the response has the "
                 "presentation and the number of notes as JSON.",
             .response = "application/octet-stream"}},
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/file.pmesh",
     .handler = show_file,
     .executor = Executor::kWorker,
     .doc = {.id = "getFile",
             .summary = "Returns the whole .pmesh file.",
             .response = "application/octet-stream"}},
    {.method = Method::kPost,
     .path = "/api/v1/models/{id}/publish",
     .handler = publish_model,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "publishModel", .summary = "Publishes a draft.", .response = "Model"}},
    {.method = Method::kPost,
     .path = "/api/v1/models/{id}/unpublish",
     .handler = unpublish_model,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "unpublishModel",
             .summary = "Turns a published model into a draft.",
             .response = "Model"}},
};

static constexpr ApiTag kModelsTags[] = {
    {.name = "models",
     .description = "Progressive meshes: metadata, streams, exports and posters."},
    {.name = "facets",
     .description = "Subjects, creators, periods and so on of the models that a search finds."}};

const ApiNoun kModels = {
    .routes = kModelRoutes, .components = kModelsComponents, .tags = kModelsTags};

}  // namespace vitrine::server
